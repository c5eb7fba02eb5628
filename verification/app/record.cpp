#include "app/record.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

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

template <int D>
RecordOf<D> make_record(const grainlaw_state* state, const TensorOf<D>& deformation,
                        const TensorOf<D>& stress, const grainlaw_report& report) {
  RecordOf<D> record;
  record.deformation = deformation;
  record.stress = stress;
  record.cauchy = cauchy_stress_of<D>(stress, deformation);
  record.void_ratio = measure_scalar(state, GRAINLAW_VOID_RATIO);
  record.coordination = measure_scalar(state, GRAINLAW_COORDINATION);
  record.coordination_no_rattlers = measure_scalar(state, GRAINLAW_COORDINATION_NO_RATTLERS);
  record.fabric_intensity = measure_scalar(state, GRAINLAW_FABRIC_INTENSITY);
  record.anisotropy = measure_scalar(state, GRAINLAW_ANISOTROPY);
  record.mean_overlap = measure_scalar(state, GRAINLAW_MEAN_OVERLAP);
  const std::vector<double> rotation = measure(state, GRAINLAW_MEAN_ROTATION);
  if constexpr (D == 2) {
    record.mean_rotation = rotation[0];
  } else {
    record.mean_rotation = std::hypot(rotation[0], rotation[1], rotation[2]);
    record.fabric = TensorOf<D>::Map(measure(state, GRAINLAW_FABRIC).data());
  }
  record.elastic_energy = measure_scalar(state, GRAINLAW_ELASTIC_ENERGY);
  record.dissipated_energy = measure_scalar(state, GRAINLAW_DISSIPATED_ENERGY);
  record.broken_bonds = measure_scalar(state, GRAINLAW_BROKEN_BONDS);
  record.escaped_particles = measure_scalar(state, GRAINLAW_ESCAPED_PARTICLES);
  record.contacts = report.contacts;
  record.sliding = report.sliding;
  record.status_changes = report.status_changes;
  record.unbalanced = report.unbalanced;
  return record;
}

template <int D>
RecordOf<D> mean(const std::vector<RecordOf<D>>& records, std::vector<double> weight) {
  using Record = RecordOf<D>;
  Record sum;
  if (records.empty()) return sum;
  sum.deformation.setZero();
  const auto [least, most] = std::minmax_element(weight.begin(), weight.end());
  const bool alike = *most - *least < 1e-9 * *most;  // but for rounding
  if (alike) weight.assign(records.size(), 1.0);
  const double total = std::accumulate(weight.begin(), weight.end(), 0.0);
  const auto add = [&](auto member) {
    for (std::size_t p = 0; p < records.size(); ++p)
      sum.*member += weight[p] * (records[p].*member);
    sum.*member /= total;
  };
  for (const auto member :
       {&Record::deformation, &Record::stress, &Record::cauchy, &Record::fabric})
    add(member);
  for (const auto member :
       {&Record::void_ratio, &Record::coordination, &Record::coordination_no_rattlers,
        &Record::fabric_intensity, &Record::anisotropy, &Record::mean_overlap,
        &Record::mean_rotation, &Record::elastic_energy, &Record::dissipated_energy,
        &Record::external_work, &Record::contacts, &Record::sliding, &Record::status_changes,
        &Record::broken_bonds, &Record::escaped_particles})
    add(member);
  for (const Record& record : records) sum.unbalanced = std::max(sum.unbalanced, record.unbalanced);
  return sum;
}

template <int D>
std::vector<std::string> record_columns(bool drag) {
  std::vector<std::string> columns{"step[-]", "axial_strain[-]", "volumetric_strain[-]",
                                   "stress_ratio[-]"};
  const auto tensor = [&](const std::string& name, const char* unit) {
    for (int i = 1; i <= D; ++i)
      for (int j = 1; j <= D; ++j)
        columns.push_back(name + std::to_string(i) + std::to_string(j) + unit);
  };
  const auto add = [&](std::initializer_list<const char*> names) {
    columns.insert(columns.end(), names.begin(), names.end());
  };
  if constexpr (D == 3)
    add({"axial_stress[Pa]", "lateral_stress[Pa]", "mean_pressure[Pa]", "deviatoric_stress[Pa]"});
  tensor("F", "[-]");
  tensor("P", "[Pa]");
  tensor("sigma", "[Pa]");
  if constexpr (D == 3) tensor("fabric", "[-]");
  // clang-format off
  add({"void_ratio[-]", "coordination[-]", "coordination_no_rattlers[-]",
       "fabric_intensity[-]", "anisotropy[-]", "mean_overlap[m]", "mean_rotation[rad]",
       "elastic_energy[J]", "dissipated_energy[J]", "external_work[J]",
       "contacts[-]", "sliding[-]", "status_changes[-]",
       "newton_iterations[-]", "evaluations[-]", "step_cuts[-]", "loose_parts[-]",
       "relaxation_steps[-]", "servo_corrections[-]", "factorisations[-]", "subincrements[-]",
       "history_advanced[-]", "broken_bonds[-]", "escaped_particles[-]", "jumps_crossed[-]"});
  // clang-format on
  if (drag) columns.emplace_back("unbalanced[-]");
  return columns;
}

template <int D>
std::vector<double> record_values(const RecordOf<D>& r, bool drag) {
  std::vector<double> values{static_cast<double>(r.step), r.axial_strain(), r.volumetric_strain(),
                             r.stress_ratio()};
  const auto tensor = [&](const TensorOf<D>& t) {
    values.insert(values.end(), t.data(), t.data() + t.size());
  };
  if constexpr (D == 3)
    values.insert(values.end(),
                  {r.axial_stress(), r.lateral_stress(), r.mean_pressure(), r.deviatoric_stress()});
  for (const TensorOf<D>* t : {&r.deformation, &r.stress, &r.cauchy}) tensor(*t);
  if constexpr (D == 3) tensor(r.fabric);
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
  if (drag) values.push_back(r.unbalanced);
  return values;
}

template RecordOf<2> make_record<2>(const grainlaw_state*, const TensorOf<2>&, const TensorOf<2>&,
                                    const grainlaw_report&);
template RecordOf<3> make_record<3>(const grainlaw_state*, const TensorOf<3>&, const TensorOf<3>&,
                                    const grainlaw_report&);
template RecordOf<2> mean<2>(const std::vector<RecordOf<2>>&, std::vector<double>);
template RecordOf<3> mean<3>(const std::vector<RecordOf<3>>&, std::vector<double>);
template std::vector<std::string> record_columns<2>(bool);
template std::vector<std::string> record_columns<3>(bool);
template std::vector<double> record_values<2>(const RecordOf<2>&, bool);
template std::vector<double> record_values<3>(const RecordOf<3>&, bool);

}  // namespace verification
