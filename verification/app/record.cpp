#include "app/record.hpp"

#include <algorithm>

namespace verification {

void Effort::add(const grainlaw_report& report) {
  ++evaluations;
  relaxation_steps += report.relaxation_steps;
  servo_corrections += report.servo_corrections;
  factorisations += report.factorisations;
  subincrements = std::max(subincrements, report.subincrements);
}

void Effort::add(const Effort& other) {
  iterations += other.iterations;
  evaluations += other.evaluations;
  cuts += other.cuts;
  loose += other.loose;
  crossed += other.crossed;
  relaxation_steps += other.relaxation_steps;
  servo_corrections += other.servo_corrections;
  factorisations += other.factorisations;
  subincrements = std::max(subincrements, other.subincrements);
  history_advanced += other.history_advanced;
}

Record make_record(const grainlaw_state* state, const Tensor& deformation, const Tensor& stress,
                   const grainlaw_report& report) {
  Record record;
  record.deformation = deformation;
  record.stress = stress;
  record.cauchy = cauchy_stress(stress, deformation);
  record.void_ratio = measure_scalar(state, GRAINLAW_VOID_RATIO);
  record.coordination = measure_scalar(state, GRAINLAW_COORDINATION);
  record.coordination_no_rattlers = measure_scalar(state, GRAINLAW_COORDINATION_NO_RATTLERS);
  record.fabric_intensity = measure_scalar(state, GRAINLAW_FABRIC_INTENSITY);
  record.anisotropy = measure_scalar(state, GRAINLAW_ANISOTROPY);
  record.mean_overlap = measure_scalar(state, GRAINLAW_MEAN_OVERLAP);
  record.mean_rotation = measure_scalar(state, GRAINLAW_MEAN_ROTATION);
  record.elastic_energy = measure_scalar(state, GRAINLAW_ELASTIC_ENERGY);
  record.dissipated_energy = measure_scalar(state, GRAINLAW_DISSIPATED_ENERGY);
  record.broken_bonds = measure_scalar(state, GRAINLAW_BROKEN_BONDS);
  record.escaped_particles = measure_scalar(state, GRAINLAW_ESCAPED_PARTICLES);
  record.contacts = report.contacts;
  record.sliding = report.sliding;
  record.status_changes = report.status_changes;
  return record;
}

Record mean(const std::vector<Record>& records) {
  Record sum;
  if (records.empty()) return sum;
  sum.deformation.setZero();
  const auto add = [&](auto member) {
    for (const Record& record : records) sum.*member += record.*member;
    sum.*member /= static_cast<double>(records.size());
  };
  add(&Record::deformation);
  add(&Record::stress);
  add(&Record::cauchy);
  for (const auto member :
       {&Record::void_ratio, &Record::coordination, &Record::coordination_no_rattlers,
        &Record::fabric_intensity, &Record::anisotropy, &Record::mean_overlap,
        &Record::mean_rotation, &Record::elastic_energy, &Record::dissipated_energy,
        &Record::external_work, &Record::contacts, &Record::sliding, &Record::status_changes,
        &Record::broken_bonds, &Record::escaped_particles})
    add(member);
  return sum;
}

std::vector<std::string> record_columns() {
  // clang-format off
  return {"step[-]", "axial_strain[-]", "volumetric_strain[-]", "stress_ratio[-]",
          "F11[-]", "F12[-]", "F21[-]", "F22[-]",
          "P11[Pa]", "P12[Pa]", "P21[Pa]", "P22[Pa]",
          "sigma11[Pa]", "sigma12[Pa]", "sigma21[Pa]", "sigma22[Pa]",
          "void_ratio[-]", "coordination[-]", "coordination_no_rattlers[-]",
          "fabric_intensity[-]", "anisotropy[-]", "mean_overlap[m]", "mean_rotation[rad]",
          "elastic_energy[J]", "dissipated_energy[J]", "external_work[J]",
          "contacts[-]", "sliding[-]", "status_changes[-]",
          "newton_iterations[-]", "evaluations[-]", "step_cuts[-]", "loose_parts[-]",
          "relaxation_steps[-]", "servo_corrections[-]", "factorisations[-]", "subincrements[-]",
          "history_advanced[-]", "broken_bonds[-]", "escaped_particles[-]", "jumps_crossed[-]"};
  // clang-format on
}

std::vector<double> record_values(const Record& r) {
  std::vector<double> values{static_cast<double>(r.step), r.axial_strain(), r.volumetric_strain(),
                             r.stress_ratio()};
  for (const Tensor* tensor : {&r.deformation, &r.stress, &r.cauchy})
    values.insert(values.end(), tensor->data(), tensor->data() + 4);
  values.insert(values.end(),
                {r.void_ratio, r.coordination, r.coordination_no_rattlers, r.fabric_intensity,
                 r.anisotropy, r.mean_overlap, r.mean_rotation, r.elastic_energy,
                 r.dissipated_energy, r.external_work, r.contacts, r.sliding, r.status_changes});
  const Effort& e = r.effort;
  for (const long count : {long{e.iterations}, long{e.evaluations}, long{e.cuts}, long{e.loose},
                           e.relaxation_steps, e.servo_corrections, long{e.factorisations},
                           long{e.subincrements}, long{e.history_advanced}})
    values.push_back(static_cast<double>(count));
  values.push_back(r.broken_bonds);
  values.push_back(r.escaped_particles);
  values.push_back(e.crossed);
  return values;
}

}  // namespace verification
