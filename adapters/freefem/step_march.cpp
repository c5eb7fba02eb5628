#include "step_march.hpp"

#include "number_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>
#include <stdexcept>
#include <variant>

namespace grainlaw_freefem {
namespace {

// A number of a struct and its name.
template <class Struct>
struct Field {
  const char* name;
  std::variant<double Struct::*, int Struct::*> member;
};

using Options = grainlaw_march_options;
using Part = grainlaw_part;

constexpr Field<Options> options[] = {{"tolerance", &Options::tolerance},
                                      {"max_iterations", &Options::max_iterations},
                                      {"max_cuts", &Options::max_cuts},
                                      {"patience", &Options::patience},
                                      {"largest_correction", &Options::largest_correction},
                                      {"crossing_part", &Options::crossing_part},
                                      {"max_crossings", &Options::max_crossings},
                                      {"step_time", &Options::step_time}};
constexpr Field<Part> parts[] = {
    {"load", &Part::load},     {"time", &Part::time},       {"keep", &Part::keep},
    {"solves", &Part::solves}, {"cuts", &Part::cuts},       {"complete", &Part::complete},
    {"loose", &Part::loose},   {"crossed", &Part::crossed}, {"residual", &Part::residual}};

template <class Struct>
const Field<Struct>& named(std::span<const Field<Struct>> fields, const std::string& name,
                           const char* what) {
  std::string names;
  for (const Field<Struct>& field : fields) {
    if (field.name == name) return field;
    names += (names.empty() ? "" : ", ") + std::string(field.name);
  }
  throw std::invalid_argument("a march has no " + std::string(what) + " \"" + name +
                              "\", expected one of " + names);
}

template <class Struct>
double read(const Struct& of, const Field<Struct>& field) {
  return std::visit([&](auto member) { return static_cast<double>(of.*member); }, field.member);
}

// False for a number that an int does not hold.
template <class Struct>
bool write(Struct& to, const Field<Struct>& field, double value) {
  if (const auto* const whole = std::get_if<int Struct::*>(&field.member)) {
    if (!(std::abs(value) <= 1e9) || value != std::round(value)) return false;
    to.*(*whole) = static_cast<int>(value);
  } else {
    to.*std::get<double Struct::*>(field.member) = value;
  }
  return true;
}

}  // namespace

double StepMarch::default_option(const std::string& name) {
  return read(grainlaw_march_options_default(), named<Options>(options, name, "option"));
}

void StepMarch::set_option(const std::string& name, double value) {
  Options changed = options_;
  try {
    grainlaw::check(write(changed, named<Options>(options, name, "option"), value)
                        ? GRAINLAW_OK
                        : GRAINLAW_BAD_ARGUMENT);
    march_ = grainlaw::March(set_, changed);
  } catch (const grainlaw::StatusError& error) {
    if (error.status() != GRAINLAW_BAD_ARGUMENT) throw;
    throw std::invalid_argument("the option \"" + name + "\" of a march is " +
                                grainlaw::adapters::shown(value) + ", which is out of its range");
  }
  options_ = changed;
}

void StepMarch::begin(double from, double to) {
  const grainlaw_status status = grainlaw_march_begin(march_.get(), from, to);
  if (status == GRAINLAW_BAD_ARGUMENT)
    throw std::invalid_argument("the load step is from " + grainlaw::adapters::shown(from) +
                                " to " + grainlaw::adapters::shown(to) + ", expected numbers");
  grainlaw::check(status);
}

double StepMarch::part(const std::string& name) const {
  return read(march_.part(), named<Part>(parts, name, "number"));
}

double StepMarch::largest(const Array& changes) const {
  std::size_t n = 1;
  for (const std::size_t extent : changes.shape) n *= extent;
  const auto square = static_cast<std::size_t>(set_->dimension() * set_->dimension());
  if (n % square != 0)
    throw std::invalid_argument("changes of F are " + std::to_string(n) + " numbers, expected " +
                                std::to_string(square) + " for each point");
  double largest = 0;  // square of a norm
  for (std::size_t k = 0; k < n; k += square) {
    double sum = 0;
    for (std::size_t c = k; c < k + square; ++c) sum += changes.data[c] * changes.data[c];
    if (!(sum <= largest)) largest = sum;
    if (std::isnan(largest)) break;
  }
  return std::sqrt(largest);
}

void StepMarch::check_turn(grainlaw_status status) const {
  if (status == GRAINLAW_BAD_ARGUMENT)
    throw std::logic_error(
        "there is nothing to tell, expected a grainlawMarchNext before that "
        "returned grainlawSOLVE or grainlawCROSS");
  grainlaw::check(status);
}

void StepMarch::tell(double residual, double scale, double unforeseen) {
  check_turn(grainlaw_march_tell(march_.get(), GRAINLAW_OK, nullptr, residual, scale, unforeseen));
}

void StepMarch::fail(double step_ratio, const std::string& reason) {
  grainlaw_summary summary = grainlaw_summary_default();
  summary.step_ratio = step_ratio;
  std::snprintf(summary.message, sizeof summary.message, "%s", reason.c_str());
  check_turn(grainlaw_march_tell(march_.get(), GRAINLAW_NOT_CONVERGED, &summary, 0, 1, 0));
}

}  // namespace grainlaw_freefem
