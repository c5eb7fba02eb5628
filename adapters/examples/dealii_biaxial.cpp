// The biaxial test of adapters/biaxial/biaxial.toml in deal.II 9.4.
//
//   dealii_biaxial MATERIAL.toml [PREFIX [STEPS]]
//
// prints the residuals of Newton's method, and writes PREFIX_force.csv and PREFIX_newton.csv.
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparse_direct.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <stdexcept>

#include "../point/number_text.hpp"
#include "../point/whole_file.hpp"
#include "dealii_mesh.hpp"
#include "dealii_points.hpp"

using namespace dealii;

namespace {

constexpr double width = 0.05, height = 0.1;  // m
constexpr double side_pressure = 100e3;       // Pa, dead load
constexpr double shortening = 1e-3;           // m, at full load
constexpr unsigned columns = 4, rows = 8;
constexpr double tolerance = 1e-10;  // |force on the unknowns| / |nodal forces of P| [-]
constexpr int max_iterations = 12;
constexpr double smallest_cut = 0.1, usual_cut = 0.5, smallest_part = 1e-3;  // of a load step

class Biaxial {
 public:
  explicit Biaxial(const grainlaw::Material& material)
      : element_(FE_SimplexP<2>(1), 2), mapping_(FE_SimplexP<2>(1)), dofs_(mesh_) {
    grainlaw_dealii::make_triangles(mesh_, {{width, height}}, {{columns, rows}});
    dofs_.distribute_dofs(element_);
    const types::global_dof_index n = dofs_.n_dofs();
    where_.resize(n);
    DoFTools::map_dofs_to_support_points(mapping_, dofs_, where_);
    in_y_ = DoFTools::extract_dofs(dofs_, element_.component_mask(FEValuesExtractors::Scalar(1)));
    DynamicSparsityPattern entries(n);
    DoFTools::make_sparsity_pattern(dofs_, entries);
    pattern_.copy_from(entries);
    stiffness_.reinit(pattern_);
    displacement_.reinit(n);
    internal_.reinit(n);
    sides_.reinit(n);
    for (types::global_dof_index d = 0; d < n; ++d)
      if (!in_y_.is_element(d)) sides_(d) = side_force(where_[d]);
    points_ =
        std::make_unique<grainlaw_dealii::Points>(mapping_, dofs_, QGaussSimplex<2>(1), material);
    if (!points_->evaluate(displacement_)) throw std::runtime_error(points_->message());
    points_->commit();
  }

  // Newton's method to a fraction of the load, in a time whose unit is a load step. True when it got there; else the state is as it was
  // and ratio is the factor on the step to try next.
  bool advance(double fraction, double time, std::vector<double>& residuals, double& ratio) {
    const Vector<double> start = displacement_;
    points_->set_time_step(time);
    residuals.clear();
    ratio = usual_cut;
    std::string reason = "Newton did not converge";
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
      correct(fraction);
      if (!points_->evaluate(displacement_)) {
        ratio = points_->step_ratio();
        reason = points_->message();
        break;
      }
      residuals.push_back(residual());
      if (residuals.back() <= tolerance) {
        points_->commit();
        return true;
      }
    }
    std::printf("load %g: %s; the step is cut\n", fraction, reason.c_str());
    points_->revert();
    displacement_ = start;
    return false;
  }

  [[nodiscard]] double top_force() const {
    double sum = 0;
    for (types::global_dof_index d = 0; d < dofs_.n_dofs(); ++d)
      if (on_platen(d) && in_y_.is_element(d) && where_[d][1] > 0) sum += internal_(d);
    return sum;
  }

 private:
  // Dead load on a node of the sides, along x [N/m].
  static double side_force(const Point<2>& X) {
    const bool left = X[0]<1e-9, right = X[0]> width - 1e-9;
    if (!left && !right) return 0;
    const bool corner = X[1] < 1e-9 || X[1] > height - 1e-9;
    return (left ? 1 : -1) * side_pressure * height / rows * (corner ? 0.5 : 1);
  }

  [[nodiscard]] bool on_platen(types::global_dof_index d) const {
    return where_[d][1] < 1e-9 || where_[d][1] > height - 1e-9;
  }

  // One linear solve; the increment of the platen enters through its right-hand side.
  void correct(double fraction) {
    AffineConstraints<double> prescribed;
    for (types::global_dof_index d = 0; d < dofs_.n_dofs(); ++d)
      if (on_platen(d)) {
        const bool moves = in_y_.is_element(d) && where_[d][1] > 0;
        prescribed.add_line(d);
        prescribed.set_inhomogeneity(d, (moves ? -shortening * fraction : 0) - displacement_(d));
      }
    prescribed.close();
    points_->internal_forces(internal_);
    points_->stiffness(stiffness_);
    Vector<double> right = sides_;
    right -= internal_;
    prescribed.condense(stiffness_, right);
    SparseDirectUMFPACK factor;
    factor.initialize(stiffness_);
    factor.solve(right);
    prescribed.distribute(right);
    displacement_ += right;
  }

  double residual() {
    points_->internal_forces(internal_);
    double squares = 0;
    for (types::global_dof_index d = 0; d < dofs_.n_dofs(); ++d)
      if (!on_platen(d)) squares += std::pow(sides_(d) - internal_(d), 2);
    return std::sqrt(squares) / internal_.l2_norm();
  }

  Triangulation<2> mesh_;
  FESystem<2> element_;
  MappingFE<2> mapping_;
  DoFHandler<2> dofs_;
  std::vector<Point<2>> where_;  // of each displacement component
  IndexSet in_y_;
  SparsityPattern pattern_;
  SparseMatrix<double> stiffness_;
  Vector<double> displacement_, internal_, sides_;  // m, N/m, N/m
  std::unique_ptr<grainlaw_dealii::Points> points_;
};

// Written whole after every load step: on a full disk the steps before it stay.
class Table {
 public:
  Table(const std::string& path, const std::string& head) : path_(path), text_(head + "\n") {
    save();
  }
  void add(const std::vector<double>& row) {
    for (std::size_t k = 0; k < row.size(); ++k)
      text_ += (k == 0 ? "" : ",") + grainlaw::adapters::shown(row[k], 17);
    text_ += "\n";
  }
  void save() const {
    grainlaw::adapters::WholeFile file(path_);
    file.write(text_.data(), text_.size());
    file.keep();
  }

 private:
  std::string path_, text_;
};

void run(const char* material, const std::string& prefix, int steps) {
  if (steps < 1) throw std::runtime_error("expected a number of load steps >= 1");
  Biaxial problem(grainlaw::Material::load(material));
  Table force(prefix + "_force.csv", "step[-],fraction[-],top_y_displacement[m],top_y_force[N/m]");
  Table newton(prefix + "_newton.csv", "step[-],iteration[-],relative_residual[-]");
  std::vector<double> residuals;
  double done = 0, ratio = 1;
  for (int step = 0; step <= steps; ++step) {
    const double goal = static_cast<double>(step) / steps;
    double next = goal;
    do {
      const double time = next > done ? (next - done) * steps : 1;
      if (!problem.advance(next, time, residuals, ratio)) {
        next = done + (next - done) * std::clamp(ratio, smallest_cut, usual_cut);
        if (next - done <= smallest_part / steps)
          throw std::runtime_error("load step " + std::to_string(step) + " fails in any parts");
        continue;
      }
      std::printf("load %g: force %.6g N/m, residuals", next, problem.top_force());
      for (const double value : residuals) std::printf(" %.1e", value);
      std::printf("\n");
      done = next;
      next = goal;
    } while (done < goal);
    force.add({double(step), goal, -shortening * goal, problem.top_force()});
    for (std::size_t k = 0; k < residuals.size(); ++k)
      newton.add({double(step), double(k + 1), residuals[k]});
    force.save();
    newton.save();
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2 || count > 4) {
    std::fprintf(stderr, "usage: dealii_biaxial MATERIAL.toml [PREFIX [STEPS]]\n");
    return 2;
  }
  try {
    run(arguments[1], count > 2 ? arguments[2] : "biaxial",
        count > 3 ? std::atoi(arguments[3]) : 20);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
