/* Points that ranks lend have the bits of those that they do not:
 *
 *   mpirun -n RANKS lending_test MATERIAL.toml OTHER.toml WRONG.toml
 *
 * Rank 0 has nearly all points, the last of several has none. Every third point is of the other material;
 * the third is of the other dimension. */
#include <grainlaw/lending.h>

#include <math.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int rank, ranks;

static void require_at(int line, int true, const char* what) {
  if (true) return;
  fprintf(stderr, "line %d, rank %d: %s\n", line, rank, what);
  MPI_Abort(MPI_COMM_WORLD, 1);
}
#define require(condition) require_at(__LINE__, condition, #condition)

static void* room(size_t count, size_t size) {
  void* const memory = malloc((count + 1) * size);
  require(memory != NULL);
  return memory;
}

static grainlaw_material* read_material(const char* path) {
  char message[256];
  grainlaw_material* material = NULL;
  const grainlaw_status status = grainlaw_material_load(path, &material, message, sizeof message);
  require_at(__LINE__, status == GRAINLAW_OK, message);
  return material;
}

static void reduce(void* context, double* values, int n, grainlaw_op op) {
  (void)context;
  MPI_Allreduce(MPI_IN_PLACE, values, n, MPI_DOUBLE, op == GRAINLAW_MIN ? MPI_MIN : MPI_SUM,
                MPI_COMM_WORLD);
}

/* A set, and what an evaluation of it gave. */
struct outcome {
  grainlaw_points* set;
  grainlaw_lending* lending; /* NULL: each rank alone */
  double *P, *A;
  grainlaw_status* statuses;
  grainlaw_report* reports;
  grainlaw_status status;
  grainlaw_summary summary;
};

enum { most = 24, per_step = 2, steps = 5, cut = 2 };

static size_t points, square;

static void evaluate(struct outcome* o, const double* F, unsigned want) {
  memset(o->P, 0x5a, points * square * sizeof(double));
  memset(o->A, 0x5a, points * square * square * sizeof(double));
  for (size_t k = 0; k < points; ++k) o->reports[k] = grainlaw_report_default();
  o->summary = grainlaw_summary_default();
  o->status = o->lending != NULL
                  ? grainlaw_lending_evaluate(o->lending, F, want, o->P, o->A, o->statuses,
                                              o->reports, &o->summary)
                  : grainlaw_points_evaluate(o->set, F, want, o->P, o->A, o->statuses, o->reports,
                                             1, &o->summary);
}

static void require_same(const struct outcome* a, const struct outcome* b) {
  require(a->status == b->status);
  require(a->summary.failed == b->summary.failed);
  require(a->summary.first_failed == b->summary.first_failed);
  require(a->summary.rank == b->summary.rank);
  require(a->summary.step_ratio == b->summary.step_ratio);
  require(strcmp(a->summary.message, b->summary.message) == 0);
  require(memcmp(a->P, b->P, points * square * sizeof(double)) == 0);
  require(memcmp(a->A, b->A, points * square * square * sizeof(double)) == 0);
  for (size_t k = 0; k < points; ++k) {
    const grainlaw_report *one = a->reports + k, *other = b->reports + k;
    require(a->statuses[k] == b->statuses[k]);
    require(one->residual == other->residual);
    require(one->step_ratio == other->step_ratio);
    require(one->relaxation_steps == other->relaxation_steps);
    require(one->factorisations == other->factorisations);
    require(one->sliding == other->sliding);
    require(one->viscous_work == other->viscous_work);
    require(strcmp(one->message, other->message) == 0);
  }
}

static void require_same_states(const struct outcome* a, const struct outcome* b) {
  size_t size = 0, other = 0;
  require(grainlaw_points_save(a->set, NULL, &size) == GRAINLAW_OK);
  require(grainlaw_points_save(b->set, NULL, &other) == GRAINLAW_OK && size == other);
  char *first = room(size, 1), *second = room(size, 1);
  require(grainlaw_points_save(a->set, first, &size) == GRAINLAW_OK);
  require(grainlaw_points_save(b->set, second, &size) == GRAINLAW_OK);
  require(memcmp(first, second, size) == 0);
  free(first);
  free(second);
}

/* Each point a little further than the one before it, by its own mixture of shortening and shear. */
static void deform(double* F, double part) {
  const size_t d = square == 4 ? 2 : 3;
  for (size_t k = 0; k < points; ++k) {
    double* const one = F + k * square;
    for (size_t c = 0; c < square; ++c) one[c] = c % (d + 1) == 0 ? 1 : 0;
    one[square - 1] -= 5e-4 * part * (double)(1 + (7 * k) % 11) / 11;
    one[1] += 3e-4 * part * (double)((5 * k) % 7) / 7;
  }
}

/* Every point is evaluated once: its processor time is another. */
static void require_all_evaluated(const struct outcome* o, double* before) {
  double* const now = room(points, sizeof *now);
  require(grainlaw_points_cost(o->set, now) == GRAINLAW_OK);
  for (size_t k = 0; k < points; ++k) require(now[k] > 0 && now[k] != before[k]);
  memcpy(before, now, points * sizeof *now);
  free(now);
}

static struct outcome make(const grainlaw_material* const* materials, const int* material_of) {
  struct outcome o = {0};
  require(grainlaw_points_create(materials[0], 0, &o.set) == GRAINLAW_OK);
  for (size_t k = 0; k < points; ++k)
    require(grainlaw_points_resize(o.set, k + 1, materials[material_of[k]]) == GRAINLAW_OK);
  o.P = room(points * square, sizeof *o.P);
  o.A = room(points * square * square, sizeof *o.A);
  o.statuses = room(points, sizeof *o.statuses);
  o.reports = room(points, sizeof *o.reports);
  require(grainlaw_points_set_time_step(o.set, 1) == GRAINLAW_OK);
  return o;
}

static void release(struct outcome* o) {
  grainlaw_lending_destroy(o->lending);
  grainlaw_points_destroy(o->set);
  free(o->P);
  free(o->A);
  free(o->statuses);
  free(o->reports);
}

/* Failures of points that are lent, of some rank, and of calls. */
static void fail(struct outcome* a, struct outcome* b, double* F) {
  const unsigned want = GRAINLAW_WANT_TANGENT_EXACT;
  deform(F, steps);
  for (size_t k = 3; k < points; ++k)
    if (k % 2 == 1) F[k * square] = 1.5;
  evaluate(a, F, want);
  evaluate(b, F, want);
  require(a->status == GRAINLAW_STEP_TOO_LARGE && a->summary.rank == (ranks > 1 ? 0 : -1));
  require_same(a, b);
  require(grainlaw_points_commit(a->set) == GRAINLAW_NO_TRIAL);
  if (points > 4) F[4 * square] = NAN; /* fatal before recoverable */
  evaluate(a, F, want);
  evaluate(b, F, want);
  require(a->status == GRAINLAW_NOT_FINITE && a->summary.first_failed == 4);
  require_same(a, b);
  deform(F, steps);
  evaluate(a, rank == 0 ? NULL : F, want);
  evaluate(b, rank == 0 ? NULL : F, want);
  require(a->status == GRAINLAW_NULL_POINTER && a->summary.failed == 0);
  require_same(a, b);
  evaluate(a, F, rank == 0 ? 3 : want);
  evaluate(b, F, rank == 0 ? 3 : want);
  require(a->status == GRAINLAW_BAD_ARGUMENT);
  require_same(a, b);
  grainlaw_summary unknown = {0};
  require(grainlaw_lending_evaluate(a->lending, F, want, a->P, a->A, NULL, NULL,
                                    rank == 0 ? &unknown : NULL) == GRAINLAW_BAD_REPORT);
  a->reports[0].size = 8;
  require(grainlaw_lending_evaluate(a->lending, F, want, a->P, a->A, NULL,
                                    rank == 0 ? a->reports : NULL, NULL) == GRAINLAW_BAD_REPORT);
  evaluate(a, F, want);
  evaluate(b, F, want);
  require(a->status == GRAINLAW_OK);
  require_same(a, b);
}

static void compare(const grainlaw_material* const* materials, const int* material_of) {
  struct outcome lent = make(materials, material_of), alone = make(materials, material_of);
  char message[256];
  const int comm = MPI_Comm_c2f(MPI_COMM_WORLD);
  require_at(__LINE__,
             grainlaw_lending_create(comm, lent.set, 2, materials, material_of, &lent.lending,
                                     message, sizeof message) == GRAINLAW_OK,
             message);
  if (ranks > 1) require(grainlaw_points_share(alone.set, rank, reduce, NULL) == GRAINLAW_OK);
  double* const F = room(points * square, sizeof *F);
  double* const seconds = calloc(points + 1, sizeof *seconds);
  for (int step = 1; step <= steps; ++step) {
    for (int iteration = 0; iteration < per_step; ++iteration) {
      deform(F, step - 0.1 * (per_step - 1 - iteration));
      evaluate(&lent, F, GRAINLAW_WANT_TANGENT_EXACT);
      require_at(__LINE__, lent.status == GRAINLAW_OK, lent.summary.message);
      require_all_evaluated(&lent, seconds);
      evaluate(&alone, F, GRAINLAW_WANT_TANGENT_EXACT);
      require_same(&lent, &alone);
    }
    if (step == cut) {
      grainlaw_points_revert(lent.set);
      grainlaw_points_revert(alone.set);
    } else {
      require(grainlaw_points_commit(lent.set) == GRAINLAW_OK);
      require(grainlaw_points_commit(alone.set) == GRAINLAW_OK);
      require_same_states(&lent, &alone);
    }
  }
  fail(&lent, &alone, F);
  const grainlaw_lent mine = grainlaw_lending_count(lent.lending);
  long counts[2] = {mine.lent, mine.taken};
  MPI_Allreduce(MPI_IN_PLACE, counts, 2, MPI_LONG, MPI_SUM, MPI_COMM_WORLD);
  require(counts[0] == counts[1]);
  require(ranks == 1 || counts[0] > 0);
  require(mine.offered >= mine.lent);
  if (rank == 0)
    printf("%d ranks, %zu points on rank 0: %ld times a point was lent, the same bits\n", ranks,
           points, counts[0]);
  release(&lent);
  release(&alone);
  free(F);
  free(seconds);
}

/* What create() refuses, the same on all ranks. */
static void refuse(const grainlaw_material* const* materials, const grainlaw_material* other) {
  const int comm = MPI_Comm_c2f(MPI_COMM_WORLD), last = rank == ranks - 1;
  const int wrong[1] = {2};
  char message[256] = "";
  grainlaw_lending* lending = NULL;
  grainlaw_points* set = NULL;
  require(grainlaw_points_create(materials[0], 1, &set) == GRAINLAW_OK);
  if (ranks > 1) {
    const grainlaw_material* const swapped[2] = {materials[last], materials[!last]};
    require(grainlaw_lending_create(comm, set, 2, swapped, NULL, &lending, message,
                                    sizeof message) == GRAINLAW_WRONG_MATERIAL);
    require(strstr(message, "not those of rank 0") != NULL);
  }
  require(grainlaw_lending_create(comm, last ? NULL : set, 1, materials, NULL, &lending, message,
                                  sizeof message) == GRAINLAW_NULL_POINTER);
  require(grainlaw_lending_create(comm, set, 2, materials, last ? wrong : NULL, &lending, NULL,
                                  0) == GRAINLAW_BAD_ARGUMENT);
  require(grainlaw_lending_create(comm, set, 0, materials, NULL, &lending, NULL, 0) ==
          GRAINLAW_BAD_ARGUMENT);
  require(grainlaw_lending_create(comm, set, 1, &other, NULL, &lending, NULL, 0) ==
          GRAINLAW_BAD_ARGUMENT);
  require(lending == NULL);
  require(grainlaw_lending_evaluate(NULL, NULL, 0, NULL, NULL, NULL, NULL, NULL) ==
          GRAINLAW_NULL_POINTER);
  grainlaw_points_destroy(set);
}

int main(int argc, char** argv) {
  char message[256];
  grainlaw_lending* none = NULL;
  require(grainlaw_lending_create(0, NULL, 0, NULL, NULL, &none, message, sizeof message) ==
          GRAINLAW_BAD_ARGUMENT);
  require(strcmp(message, "MPI is not running") == 0);
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  require(argc == 4);
  grainlaw_material *first = read_material(argv[1]), *second = read_material(argv[2]);
  grainlaw_material* const third = read_material(argv[3]);
  const grainlaw_material* const materials[2] = {first, second};
  const size_t d = (size_t)grainlaw_material_dimension(first);
  square = d * d;
  points = rank == 0 ? most : rank == ranks - 1 ? 0 : 2;
  int material_of[most];
  for (int k = 0; k < most; ++k) material_of[k] = k % 3 == 2;
  refuse(materials, third);
  compare(materials, material_of);
  grainlaw_material_destroy(first);
  grainlaw_material_destroy(second);
  grainlaw_material_destroy(third);
  MPI_Finalize();
  return 0;
}
