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
    const auto found = points_->evaluate(displacement_);
    if (!found) throw std::runtime_error(found.message());
    points_->commit();
    auto options = grainlaw_march_options_default();
    options.tolerance = tolerance;
    march_ = std::make_unique<grainlaw::March>(&points_->set(), options);
  }

  // A load step, as the march leads; accepted(load, residuals) after each part of it.
  template <class Accepted>
  void advance(double from, double to, const Accepted& accepted) {
    Vector<double> committed = displacement_, farthest;
    std::vector<double> residuals;
    march_->begin(from, to);
    for (grainlaw_action now; (now = march_->next()) != GRAINLAW_DONE;) {
      const grainlaw_part& part = march_->part();
      if (part.keep) farthest = displacement_;
      if (now == GRAINLAW_SOLVE) {
        if (correct(part.load)) residuals.push_back(tell());
      } else if (now == GRAINLAW_CROSS) {
        displacement_ = farthest;
        tell();
      } else if (now == GRAINLAW_ACCEPT) {
        points_->commit();
        committed = displacement_;
        accepted(part.load, residuals);
        residuals.clear();
      } else {
        points_->revert();
        displacement_ = committed;
        residuals.clear();
        if (now == GRAINLAW_GIVE_UP) throw std::runtime_error(part.message);
        std::printf("load %g: %s; the step is cut\n", part.load, part.message);
      }
    }
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

  // One linear solve; the increment of the platen enters through its right-hand side. False: the
  // stiffness is singular.
  bool correct(double fraction) {
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
    const double share = march_->share(points_->largest_change(right));
    if (share > 0) displacement_.add(share, right);
    return share > 0;
  }

  // Evaluates and tells the march. The relative residual.
  double tell() {
    const auto found = points_->evaluate(displacement_);
    points_->internal_forces(internal_);
    double squares = 0;
    for (types::global_dof_index d = 0; d < dofs_.n_dofs(); ++d)
      if (!on_platen(d)) squares += std::pow(sides_(d) - internal_(d), 2);
    march_->tell(found, std::sqrt(squares), internal_.l2_norm());
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
  std::unique_ptr<grainlaw::March> march_;
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
  double done = 0;
  for (int step = 0; step <= steps; ++step) {
    const double goal = static_cast<double>(step) / steps;
    std::vector<double> last;
    problem.advance(done, goal, [&](double load, const std::vector<double>& residuals) {
      std::printf("load %g: force %.6g N/m, residuals", load, problem.top_force());
      for (const double value : residuals) std::printf(" %.1e", value);
      std::printf("\n");
      last = residuals;
    });
    done = goal;
    force.add({double(step), goal, -shortening * goal, problem.top_force()});
    for (std::size_t k = 0; k < last.size(); ++k)
      newton.add({double(step), double(k + 1), last[k]});
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
