// A point of a table, asked in three dimensions: a packing of discs enters as plane strain.
#pragma once

#include "stress_tangent.hpp"

#include <grainlaw/grainlaw.hpp>

#include <string>

namespace grainlaw::adapters {

struct Answer {
  grainlaw_status status = GRAINLAW_OK;  // OK, or recoverable
  grainlaw_report report = grainlaw_report_default();
  bool approximate = false;  // found, but with friction history advanced on the way
};

// What a host asks of a point: the arguments of grainlaw_table_evaluate.
struct PointCall {
  long long element, point;
  double* token;      // may be null
  const Tensor2* F0;  // may be null
  const Tensor2* F;   // null: at the start of the increment
  double time_step = 0;
  unsigned want = 0;
};

// P and, when wanted, dP/dF. Throws std::runtime_error with a text for the host when F or F0 is not
// finite or not plane strain, grainlaw::StatusError for the library's own.
Answer evaluate(grainlaw::Table& table, const PointCall& call, Response& response);

// Evaluates for a host that takes S, Cauchy stress or a tangent of theirs: also throws where F^-1 P is
// not symmetric up to what is out of balance.
Answer evaluate_symmetric(grainlaw::Table& table, const PointCall& call, Response& response);

// The time step that a host tells; 0 where it tells none.
double time_step_of(double told);

// "F12" for index 1.
std::string component_name(int index);

}  // namespace grainlaw::adapters
