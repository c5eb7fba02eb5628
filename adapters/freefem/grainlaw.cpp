// FreeFEM plugin: `load "grainlaw"`. A set of points is a number >= 1 made by grainlawCreate;
// tensors are columns of real[int,int] (components by points), or the same numbers in a real[int].
//
//   int sand = grainlawCreate("sand.toml", n)          n points at F = I; the number of the set
//   grainlawCreate(materials, counts)                  counts[k] points of materials[k], one after
//                                                      the other (string[int], int[int]); a rank
//                                                      may have none
//   grainlawConsolidate(sand, sigma, reached, "k0", overconsolidation)
//       leads all points to Cauchy stresses [dim^2, n] and makes that F = I; also "proportional"
//       and "isotropic"; all points or none
//   grainlawEvaluate(sand, F, P [, A [, threads]])     number of points that found no equilibrium
//       F, P [dim^2, n]: component i*dim+J; A [dim^4, n]: dP_iJ/dF_kL at ((i*dim+J)*dim+k)*dim+L
//   grainlawAnswer(sand, P [, A])                      P and A as they were committed, without an
//                                                      increment: after grainlawLoad
//   grainlawSetTimeStep(sand, time)                    how long increments take from now on, for a
//                                                      material with solver.viscous_rate or
//                                                      solver.inertia (then in s)
//   grainlawStepRatio(sand), grainlawFirstFailed(sand), grainlawMessage(sand)
//       of the last evaluation: by how much to shorten the step, which point failed first (-1:
//       none) and why
//   grainlawPointSeconds(sand)                         processor time of the points in it, without
//                                                      waits for other ranks [s]
//   grainlawCommit(sand), grainlawRevert(sand)         when the load step has converged, or is cut
//   grainlawSave(sand, "file"), grainlawLoad(sand, "file")
//   grainlawMeasure(sand, "void_ratio", values)        [components, n], or [n] for a scalar
//   grainlawWriteVtk(sand, point, "file.vtp")
//   grainlawPoints(sand), grainlawDimension(sand), grainlawDestroy(sand)
//
// Ranks own the elements rank, rank + ranks, ... of a mesh (Vh: one component, Qh: of Element_QF):
//
//   grainlawOwnPoints(Qh, rank, ranks, numbers)        of the rank's points in Qh (int[int])
//   grainlawOwnRows(Vh, Qh, rank, ranks, axis, row, column, value)
//       entries of the matrix from Vh to values there (axis 0) or derivatives
//
// Which part of a load step comes next, as march.h tells; names are those of its structs:
//
//   grainlawMarchOption(sand, "tolerance", 1e-6)       between load steps; the default of the
//   grainlawMarchOption("tolerance")                   library
//   grainlawMarchBegin(sand, from, to)                 a load step
//   grainlawMarchNext(sand)                            grainlawSOLVE, grainlawACCEPT,
//                                                      grainlawBACK, grainlawCROSS,
//                                                      grainlawGIVEUP or grainlawDONE
//   grainlawMarchPart(sand, "load")                    where it stands
//   grainlawMarchMessage(sand)                         why an attempt failed
//   grainlawMarchShare(sand, dF)                       share of a correction to apply, of its
//                                                      changes of F, or of the largest norm of them
//   grainlawLargest(sand, dF)                          that norm, for ranks to agree on
//   grainlawMarchTell(sand, residual, scale, unforeseen)
//   grainlawMarchFail(sand, stepRatio, message)        points found no equilibrium
//
// What cannot be done throws an ExecError, which `try ... catch(...)` catches; grainlawLastError()
// has its text, and grainlawThrowAgain() in the catch block goes on with it. What was committed
// stays as it was. On several ranks one that ends by an error, or by exit(n), ends all of them; an
// error that is to be caught on all has to be agreed first, as grainlaw.idp does:
//
//   grainlawErrorText(text), grainlawThrow(rank, text)  the last error as numbers in a real[int],
//                                                       to be sent; the same error, of that rank
#include "floating_environment.hpp"
#include "last_words.hpp"
#include "own_points.hpp"
#include "point_set.hpp"
#include "step_march.hpp"

#include <ff++.hpp>

#include <AFunction_ext.hpp>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <type_traits>
#include <vector>

namespace {

using grainlaw_freefem::Array;
using grainlaw_freefem::LastWords;
using grainlaw_freefem::PointSet;
using grainlaw_freefem::StepMarch;

using Vector = KN<double>*;   // real[int]
using Matrix = KNM<double>*;  // real[int,int]

// Points and their march.
struct Led {
  PointSet points;
  StepMarch march;
  Led(const std::vector<std::string>& materials, const std::vector<long>& counts)
      : points(materials, counts), march(points.points()) {}
};

// Numbers of sets are never used twice, so that a stale one is told.
std::map<long, std::unique_ptr<Led>> sets;
long last_number = 0;
std::string last_error;
LastWords* last_words = nullptr;  // on several ranks

Array view(Vector array) {
  return {static_cast<double*>(*array), {static_cast<std::size_t>(array->N())}};
}

Array view(Matrix array) {
  return {static_cast<double*>(*array),
          {static_cast<std::size_t>(array->N()), static_cast<std::size_t>(array->M())}};
}

// FreeFEM's own error, with its text for the script.
[[noreturn]] void fail(const std::string& text) {
  last_error = text;
  throw ErrorExec(last_error.c_str(), 1);
}

// A rank that ends by an error, of whatever kind, would wait in MPI_Finalize for others that wait
// for it elsewhere. One that ends with a status and without MPI_Finalize makes mpirun end them all.
void end_all_ranks() {
  std::cerr.rdbuf(last_words->to());
  const int code = last_words->code();
  if (code == 0) return;
  std::cerr << "grainlaw: the error of rank " << mpirank << " ends all " << mpisize << " ranks"
            << std::endl;
  std::cout.flush();
  std::fflush(nullptr);
  std::_Exit(code);
}

void hear_last_words() {
  if (mpisize < 2) return;
  last_words = new LastWords(std::cerr.rdbuf());  // the stream lives longer than the plugin
  std::cerr.rdbuf(last_words);
  ff_atend(end_all_ranks);
}

// Runs a command; whatever goes wrong becomes FreeFEM's own error.
template <class Command>
auto guarded(const char* name, Command&& command) {
  const grainlaw::adapters::FloatingEnvironment environment;
  try {
    return command();
  } catch (const std::exception& error) {
    fail(std::string(name) + ": " + error.what());
  }
}

Led& find_led(long number) {
  const auto found = sets.find(number);
  if (found == sets.end())
    throw std::invalid_argument("there is no set of points number " + std::to_string(number) +
                                ", expected a result of grainlawCreate");
  return *found->second;
}

PointSet& find(long number) { return find_led(number).points; }
StepMarch& find_march(long number) { return find_led(number).march; }

string* for_script(Stack stack, const std::string& text) {
  return Add2StackOfPtr2Free(stack, new string(text));
}

long create(string* const& path, const long& points) {
  return guarded("grainlawCreate", [&] {
    if (points < 1)
      throw std::invalid_argument("the number of points is " + std::to_string(points) +
                                  ", expected at least 1");
    sets.emplace(last_number + 1,
                 std::make_unique<Led>(std::vector{std::string(*path)}, std::vector{points}));
    return ++last_number;
  });
}

using Strings = KN<String>*;  // string[int]
using Integers = KN<long>*;   // int[int]

long create(const Strings& paths, const Integers& points) {
  return guarded("grainlawCreate", [&] {
    std::vector<std::string> materials;
    for (long k = 0; k < paths->N(); ++k) materials.emplace_back(**(*paths)[k].getap());
    std::vector<long> counts;
    for (long k = 0; k < points->N(); ++k) counts.push_back((*points)[k]);
    sets.emplace(last_number + 1, std::make_unique<Led>(materials, counts));
    return ++last_number;
  });
}

template <class Field>
long consolidate(const long& number, const Field& sigma, const Field& reached, string* const& route,
                 const double& overconsolidation) {
  return guarded("grainlawConsolidate", [&] {
    find(number).consolidate(view(sigma), view(reached), *route, overconsolidation);
    return 0L;
  });
}

template <class Field>
long evaluate(const long& number, const Field& F, const Field& P) {
  return guarded("grainlawEvaluate",
                 [&] { return find(number).evaluate(view(F), view(P), nullptr, 0); });
}

template <class Field>
long evaluate(const long& number, const Field& F, const Field& P, const Field& A,
              const long& threads) {
  return guarded("grainlawEvaluate", [&] {
    const Array tangent = view(A);
    return find(number).evaluate(view(F), view(P), &tangent, threads);
  });
}

template <class Field>
long evaluate(const long& number, const Field& F, const Field& P, const Field& A) {
  return evaluate(number, F, P, A, 0);
}

template <class Field>
long answer(const long& number, const Field& P) {
  return guarded("grainlawAnswer", [&] { return find(number).answer(view(P), nullptr); });
}

template <class Field>
long answer(const long& number, const Field& P, const Field& A) {
  return guarded("grainlawAnswer", [&] {
    const Array tangent = view(A);
    return find(number).answer(view(P), &tangent);
  });
}

long set_time_step(const long& number, const double& step) {
  return guarded("grainlawSetTimeStep", [&] { return find(number).set_time_step(step), 0L; });
}

long commit(const long& number) {
  return guarded("grainlawCommit", [&] { return find(number).commit(), 0L; });
}

long revert(const long& number) {
  return guarded("grainlawRevert", [&] { return find(number).revert(), 0L; });
}

long save(const long& number, string* const& path) {
  return guarded("grainlawSave", [&] { return find(number).save(*path), 0L; });
}

long load(const long& number, string* const& path) {
  return guarded("grainlawLoad", [&] { return find(number).load(*path), 0L; });
}

template <class Field>
long measure(const long& number, string* const& name, const Field& values) {
  return guarded("grainlawMeasure", [&] { return find(number).measure(*name, view(values)), 0L; });
}

long write_vtk(const long& number, const long& point, string* const& path) {
  return guarded("grainlawWriteVtk", [&] { return find(number).write_vtk(point, *path), 0L; });
}

double step_ratio(const long& number) {
  return guarded("grainlawStepRatio", [&] { return find(number).last().summary.step_ratio; });
}

double point_seconds(const long& number) {
  return guarded("grainlawPointSeconds", [&] {
    const std::vector<double> cost = find(number).points().cost();
    return std::accumulate(cost.begin(), cost.end(), 0.0);
  });
}

long first_failed(const long& number) {
  return guarded("grainlawFirstFailed", [&] { return find(number).last().summary.first_failed; });
}

string* message(Stack stack, const long& number) {
  return guarded("grainlawMessage",
                 [&] { return for_script(stack, find(number).last().message()); });
}

long points(const long& number) {
  return guarded("grainlawPoints", [&] { return find(number).size(); });
}

long dimension(const long& number) {
  return guarded("grainlawDimension", [&] { return find(number).dimension(); });
}

long destroy(const long& number) {
  return guarded("grainlawDestroy", [&] {
    find(number);
    sets.erase(number);
    return 0L;
  });
}

double default_option(string* const& name) {
  return guarded("grainlawMarchOption", [&] { return StepMarch::default_option(*name); });
}

long set_option(const long& number, string* const& name, const double& value) {
  return guarded("grainlawMarchOption",
                 [&] { return find_march(number).set_option(*name, value), 0L; });
}

long march_begin(const long& number, const double& from, const double& to) {
  return guarded("grainlawMarchBegin", [&] { return find_march(number).begin(from, to), 0L; });
}

long march_next(const long& number) {
  return guarded("grainlawMarchNext", [&] { return static_cast<long>(find_march(number).next()); });
}

double march_part(const long& number, string* const& name) {
  return guarded("grainlawMarchPart", [&] { return find_march(number).part(*name); });
}

string* march_message(Stack stack, const long& number) {
  return guarded("grainlawMarchMessage",
                 [&] { return for_script(stack, find_march(number).message()); });
}

double largest(const long& number, const Vector& changes) {
  return guarded("grainlawLargest", [&] { return find_march(number).largest(view(changes)); });
}

double march_share(const long& number, const Vector& changes) {
  return guarded("grainlawMarchShare", [&] {
    StepMarch& march = find_march(number);
    return march.share(march.largest(view(changes)));
  });
}

double march_share_of(const long& number, const double& largest) {
  return guarded("grainlawMarchShare", [&] { return find_march(number).share(largest); });
}

template <class Space>
long own_points(Space* const& Q, const long& rank, const long& ranks, const Integers& numbers) {
  return guarded("grainlawOwnPoints", [&] {
    const typename std::remove_pointer_t<Space>::FESpace* const of = **Q;
    grainlaw_freefem::own_points(*of, rank, ranks, *numbers);
    return 0L;
  });
}

template <class Space>
long own_rows(Space* const& V, Space* const& Q, const long& rank, const long& ranks,
              const long& axis, const Integers& row, const Integers& column, const Vector& value) {
  return guarded("grainlawOwnRows", [&] {
    using Of = typename std::remove_pointer_t<Space>::FESpace;
    const Of* const from = **V;
    const Of* const at = **Q;
    grainlaw_freefem::own_rows(*from, *at, rank, ranks, axis, *row, *column, *value);
    return 0L;
  });
}

long march_tell(const long& number, const double& residual, const double& scale,
                const double& unforeseen) {
  return guarded("grainlawMarchTell",
                 [&] { return find_march(number).tell(residual, scale, unforeseen), 0L; });
}

long march_fail(const long& number, const double& step_ratio, string* const& reason) {
  return guarded("grainlawMarchFail",
                 [&] { return find_march(number).fail(step_ratio, *reason), 0L; });
}

string* text_of_last_error() { return &last_error; }

// Copies as much of its text as there is room for, then zeros.
long error_text(const Vector& numbers) {
  for (long k = 0; k < numbers->N(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    (*numbers)[k] = at < last_error.size() ? static_cast<unsigned char>(last_error[at]) : 0;
  }
  return 0;
}

long throw_error(const long& rank, const Vector& numbers) {
  const grainlaw::adapters::FloatingEnvironment environment;
  std::string text;
  for (long k = 0; k < numbers->N() && (*numbers)[k] > 0; ++k)
    text += static_cast<char>(static_cast<unsigned char>((*numbers)[k]));
  fail((mpisize > 1 ? "rank " + std::to_string(rank) + ": " : "") + text);
}

long throw_again() {
  if (std::current_exception()) throw;
  return 0;
}

template <class Space>
void add_functions_of_spaces() {
  Global.Add("grainlawOwnPoints", "(",
             new OneOperator4_<long, Space*, long, long, Integers>(own_points<Space>));
  Global.Add("grainlawOwnRows", "(",
             new OneOperator8_<long, Space*, Space*, long, long, long, Integers, Integers, Vector>(
                 own_rows<Space>));
}

template <class Field>
void add_array_functions() {
  Global.Add("grainlawEvaluate", "(", new OneOperator3_<long, long, Field, Field>(evaluate<Field>));
  Global.Add("grainlawEvaluate", "(",
             new OneOperator4_<long, long, Field, Field, Field>(evaluate<Field>));
  Global.Add("grainlawEvaluate", "(",
             new OneOperator5_<long, long, Field, Field, Field, long>(evaluate<Field>));
  Global.Add("grainlawConsolidate", "(",
             new OneOperator5_<long, long, Field, Field, string*, double>(consolidate<Field>));
  Global.Add("grainlawAnswer", "(", new OneOperator2_<long, long, Field>(answer<Field>));
  Global.Add("grainlawAnswer", "(", new OneOperator3_<long, long, Field, Field>(answer<Field>));
  Global.Add("grainlawMeasure", "(", new OneOperator3_<long, long, string*, Field>(measure<Field>));
}

void add_march_functions() {
  Global.New("grainlawSOLVE", CConstant<long>(GRAINLAW_SOLVE));
  Global.New("grainlawACCEPT", CConstant<long>(GRAINLAW_ACCEPT));
  Global.New("grainlawBACK", CConstant<long>(GRAINLAW_BACK));
  Global.New("grainlawCROSS", CConstant<long>(GRAINLAW_CROSS));
  Global.New("grainlawGIVEUP", CConstant<long>(GRAINLAW_GIVE_UP));
  Global.New("grainlawDONE", CConstant<long>(GRAINLAW_DONE));
  Global.Add("grainlawMarchOption", "(", new OneOperator1_<double, string*>(default_option));
  Global.Add("grainlawMarchOption", "(",
             new OneOperator3_<long, long, string*, double>(set_option));
  Global.Add("grainlawMarchBegin", "(", new OneOperator3_<long, long, double, double>(march_begin));
  Global.Add("grainlawMarchNext", "(", new OneOperator1_<long, long>(march_next));
  Global.Add("grainlawMarchPart", "(", new OneOperator2_<double, long, string*>(march_part));
  Global.Add("grainlawMarchMessage", "(", new OneOperator1s_<string*, long>(march_message));
  Global.Add("grainlawMarchShare", "(", new OneOperator2_<double, long, Vector>(march_share));
  Global.Add("grainlawMarchShare", "(", new OneOperator2_<double, long, double>(march_share_of));
  Global.Add("grainlawLargest", "(", new OneOperator2_<double, long, Vector>(largest));
  Global.Add("grainlawMarchTell", "(",
             new OneOperator4_<long, long, double, double, double>(march_tell));
  Global.Add("grainlawMarchFail", "(", new OneOperator3_<long, long, double, string*>(march_fail));
}

void add_functions() {
  hear_last_words();
  add_march_functions();
  Global.Add("grainlawCreate", "(", new OneOperator2_<long, string*, long>(create));
  Global.Add("grainlawCreate", "(", new OneOperator2_<long, Strings, Integers>(create));
  add_functions_of_spaces<pfes>();
  add_functions_of_spaces<pfes3>();
  add_array_functions<Vector>();
  add_array_functions<Matrix>();
  Global.Add("grainlawSetTimeStep", "(", new OneOperator2_<long, long, double>(set_time_step));
  Global.Add("grainlawCommit", "(", new OneOperator1_<long, long>(commit));
  Global.Add("grainlawRevert", "(", new OneOperator1_<long, long>(revert));
  Global.Add("grainlawSave", "(", new OneOperator2_<long, long, string*>(save));
  Global.Add("grainlawLoad", "(", new OneOperator2_<long, long, string*>(load));
  Global.Add("grainlawWriteVtk", "(", new OneOperator3_<long, long, long, string*>(write_vtk));
  Global.Add("grainlawStepRatio", "(", new OneOperator1_<double, long>(step_ratio));
  Global.Add("grainlawPointSeconds", "(", new OneOperator1_<double, long>(point_seconds));
  Global.Add("grainlawFirstFailed", "(", new OneOperator1_<long, long>(first_failed));
  Global.Add("grainlawMessage", "(", new OneOperator1s_<string*, long>(message));
  Global.Add("grainlawPoints", "(", new OneOperator1_<long, long>(points));
  Global.Add("grainlawDimension", "(", new OneOperator1_<long, long>(dimension));
  Global.Add("grainlawDestroy", "(", new OneOperator1_<long, long>(destroy));
  Global.Add("grainlawLastError", "(", new OneOperator0<string*>(text_of_last_error));
  Global.Add("grainlawErrorText", "(", new OneOperator1_<long, Vector>(error_text));
  Global.Add("grainlawThrow", "(", new OneOperator2_<long, long, Vector>(throw_error));
  Global.Add("grainlawThrowAgain", "(", new OneOperator0<long>(throw_again));
}

}  // namespace

LOADFUNC(add_functions)
