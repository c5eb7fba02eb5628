/* Points lent between ranks. In its window an owner offers the later ones of its points: bytes, F and a
 * number that counts down as they are taken, by itself too. What a rank takes it gets, evaluates, and
 * puts back in the same place. */
#include <grainlaw/lending.h>
#include <grainlaw/trials.h>

#include <mpi.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Share of the ranks' mean time that an owner keeps points for, by what they took last [-]. */
static const double own_share = 0.5;
/* What a point has to take over what its owner spends on moving it; the other rank spends as much [-]. */
static const double worth = 2;
/* Room of a point in the window over its bytes, for the answer's contacts and slopes [-]. */
static const size_t answer_room = 2;
static const double growth = 1.5; /* of a window over what is missing [-] */

struct head {
  int64_t open; /* number of the evaluation whose points are offered */
  int64_t next; /* points left: the next is slot next - 1 */
};

struct slot {
  int64_t at, room;     /* of its bytes in the window: F, state, trial; then the answer */
  int64_t state, trial; /* sizes */
  int64_t want, material;
  double left; /* seconds of the points that are taken after this one */
};

struct answer { /* P, A where wanted, and the trial are behind it */
  int64_t done; /* 0: not evaluated, the owner has to */
  int64_t trial;
  int64_t status;
  grainlaw_summary summary;
  grainlaw_report report;
};

struct rank {
  double seconds; /* of all its points, last time */
  int64_t grows;  /* 1: its window has too little room */
};

struct point {
  double seconds;
  size_t number;
};

struct grainlaw_lending {
  MPI_Comm comm;
  int rank, ranks;
  grainlaw_points* set;
  size_t square;
  size_t materials, numbered;
  grainlaw_points** others; /* a point of each material, for those of other ranks */
  int* material_of;         /* NULL: all are of the first */
  MPI_Win window;
  char* memory;
  size_t room, needed; /* of the window; what the last plan would have used */
  int64_t evaluation;
  struct rank* all;
  double* left;    /* of each rank, as far as known; 0: nothing to take */
  int64_t* opened; /* evaluation in which a rank was seen to offer last */
  int64_t* asked;  /* round in which it was asked last */
  /* One of each of the set's points: */
  size_t points;
  double* seconds;
  struct point* order; /* own ones, then those offered, each the dearest first */
  size_t* numbers;     /* of those offered, by slots */
  size_t *states, *trials;
  char* own; /* slots that this rank took itself */
  size_t kept, offered;
  char* buffer; /* a point of another rank */
  size_t buffer_size;
  double packs, unpacks; /* least seconds seen of a point; 0: none yet */
  grainlaw_lent count;
};

/* The arguments of an evaluation, and what it came to on this rank. */
struct call {
  const double* F;
  unsigned want;
  double *P, *A;
  grainlaw_status* statuses;
  grainlaw_report* reports;
  grainlaw_status status;
  grainlaw_summary found;
};

/* Keeps the least of what one of n took. */
static void least_of(double* least, double took, size_t n) {
  if (n > 0 && (*least == 0 || took / (double)n < *least)) *least = took / (double)n;
}

static double processor_time(void) {
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void reduce(void* context, double* values, int n, grainlaw_op op) {
  const grainlaw_lending* const l = context;
  MPI_Allreduce(MPI_IN_PLACE, values, n, MPI_DOUBLE, op == GRAINLAW_MIN ? MPI_MIN : MPI_SUM,
                l->comm);
}

/* ---- outcomes ------------------------------------------------------------------------------- */

static void add(struct call* call, size_t point, grainlaw_status status,
                const grainlaw_summary* one) {
  if (status == GRAINLAW_OK) return;
  const int fatal = status < 0, known = call->status < 0;
  const int first = call->found.failed == 0 || fatal > known ||
                    (fatal == known && (long)point < call->found.first_failed);
  ++call->found.failed;
  if (one->step_ratio < call->found.step_ratio) call->found.step_ratio = one->step_ratio;
  if (!first) return;
  call->status = status;
  call->found.first_failed = (long)point;
  memcpy(call->found.message, one->message, sizeof one->message);
}

static void refuse(struct call* call, grainlaw_status status, const char* why) {
  call->status = status;
  call->found = grainlaw_summary_default();
  call->found.step_ratio = 0;
  snprintf(call->found.message, sizeof call->found.message, "%s", why);
}

/* Replaces status and summary by those of all ranks: fatal before recoverable, then the lowest. */
static void agree(const grainlaw_lending* l, struct call* call) {
  const double none = 2.0 * l->ranks;
  double least[2] = {none, call->found.step_ratio};
  if (call->status != GRAINLAW_OK) least[0] = l->rank + (call->status < 0 ? 0 : l->ranks);
  MPI_Allreduce(MPI_IN_PLACE, least, 2, MPI_DOUBLE, MPI_MIN, l->comm);
  if (least[0] == none) return;
  const int first = (int)least[0] % l->ranks;
  long failed = call->found.failed;
  MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_LONG, MPI_SUM, l->comm);
  int64_t status = call->status;
  MPI_Bcast(&status, 1, MPI_INT64_T, first, l->comm);
  MPI_Bcast(&call->found, sizeof call->found, MPI_BYTE, first, l->comm);
  call->status = (grainlaw_status)status;
  call->found.failed = failed;
  call->found.step_ratio = least[1];
  call->found.rank = first;
}

static void copy_out(const void* from, void* to) {
  size_t size;
  memcpy(&size, to, sizeof size);
  memcpy((char*)to + sizeof size, (const char*)from + sizeof size, size - sizeof size);
}

static grainlaw_report* report_at(const struct call* call, size_t point) {
  if (call->reports == NULL) return NULL;
  const size_t alignment = _Alignof(grainlaw_report);
  const size_t stride = (call->reports->size + alignment - 1) / alignment * alignment;
  return (grainlaw_report*)((char*)call->reports + point * stride);
}

/* What grainlaw_points_evaluate refuses a call for. */
static grainlaw_status check(const grainlaw_lending* l, const struct call* call, unsigned want) {
  if (l->points == 0) return GRAINLAW_OK;
  if (call->F == NULL) return GRAINLAW_NULL_POINTER;
  if (call->reports != NULL) {
    const size_t first = offsetof(grainlaw_report, message) + sizeof call->reports->message;
    const size_t size = call->reports->size;
    if (size < first || size > sizeof(grainlaw_report)) return GRAINLAW_BAD_REPORT;
    for (size_t k = 0; k < l->points; ++k)
      if (report_at(call, k)->size != size) return GRAINLAW_BAD_REPORT;
  }
  const int known = want == 0 || want == GRAINLAW_WANT_TANGENT_EXACT ||
                    want == GRAINLAW_WANT_TANGENT_ELASTIC ||
                    want == GRAINLAW_WANT_TANGENT_PERTURBED;
  return known ? GRAINLAW_OK : GRAINLAW_BAD_ARGUMENT;
}

static void evaluate_own(grainlaw_lending* l, struct call* call, size_t point) {
  const double start = processor_time();
  const size_t square = l->square;
  grainlaw_summary one = grainlaw_summary_default();
  const grainlaw_status status = grainlaw_points_evaluate_some(
      l->set, 1, &point, call->F + point * square, 0, call->want,
      call->P == NULL ? NULL : call->P + point * square, 0,
      call->A == NULL ? NULL : call->A + point * square * square, 0,
      call->statuses == NULL ? NULL : call->statuses + point, report_at(call, point), 1, &one);
  add(call, point, status, &one);
  l->count.own += processor_time() - start;
}

/* ---- what is offered ------------------------------------------------------------------------ */

static int dearer(const void* a, const void* b) {
  const struct point *first = a, *second = b;
  if (first->seconds != second->seconds) return first->seconds > second->seconds ? -1 : 1;
  return first->number < second->number ? -1 : 1;
}

static int resized(void* memory, size_t count, size_t size) {
  void** const at = memory;
  void* const more = realloc(*at, count * size);
  if (more == NULL) return 0;
  *at = more;
  return 1;
}

/* Workspaces for the points that the set has now. */
static int reserve(grainlaw_lending* l) {
  const size_t n = grainlaw_points_size(l->set);
  if (!resized(&l->seconds, n + 1, sizeof *l->seconds) ||
      !resized(&l->order, n + 1, sizeof *l->order) ||
      !resized(&l->numbers, n + 1, sizeof *l->numbers) ||
      !resized(&l->states, n + 1, sizeof *l->states) ||
      !resized(&l->trials, n + 1, sizeof *l->trials) || !resized(&l->own, n + 1, 1))
    return 0;
  l->points = n;
  return 1;
}

/* Makes all windows anew where one has too little room. */
static void grow(grainlaw_lending* l) {
  int grows = 0;
  for (int r = 0; r < l->ranks; ++r) grows |= l->all[r].grows != 0;
  if (!grows) return;
  if (l->window != MPI_WIN_NULL) {
    MPI_Win_unlock_all(l->window);
    MPI_Win_free(&l->window);
  }
  if (l->needed > l->room) l->room = (size_t)(growth * (double)l->needed);
  if (l->room < sizeof(struct head)) l->room = sizeof(struct head);
  MPI_Win_allocate((MPI_Aint)l->room, 1, MPI_INFO_NULL, l->comm, &l->memory, &l->window);
  memset(l->memory, 0, sizeof(struct head));
  MPI_Win_lock_all(MPI_MODE_NOCHECK, l->window);
  MPI_Barrier(l->comm);
}

static size_t room_of(const grainlaw_lending* l, size_t state, size_t trial) {
  const size_t numbers = sizeof(double) * l->square * (1 + l->square);
  const size_t going = numbers + state + trial;
  const size_t coming = sizeof(struct answer) + numbers + answer_room * (state + trial);
  return ((going > coming ? going : coming) + 63) / 64 * 64;
}

static double mean_of_ranks(const grainlaw_lending* l) {
  double sum = 0;
  for (int r = 0; r < l->ranks; ++r) sum += l->all[r].seconds;
  return sum / l->ranks;
}

/* Orders the points: those that are kept, then those to offer, each the dearest first. */
static void plan(grainlaw_lending* l) {
  const double mean = mean_of_ranks(l);
  double before = 0;
  const double least = worth * (l->packs + l->unpacks);
  for (size_t k = 0; k < l->points; ++k) l->order[k] = (struct point){l->seconds[k], k};
  qsort(l->order, l->points, sizeof *l->order, dearer);
  l->kept = l->offered = 0;
  for (size_t k = 0; k < l->points; ++k) {
    const struct point one = l->order[k];
    const int lendable = l->material_of == NULL || one.number < l->numbered;
    if (before >= own_share * mean && one.seconds > least && lendable)
      l->numbers[l->offered++] = one.number;
    else
      l->order[l->kept++] = one;
    before += one.seconds;
  }
}

/* Sizes of the offered points; those without room stay with their owner. */
static void fit(grainlaw_lending* l) {
  size_t n = l->offered;
  if (grainlaw_points_save_some(l->set, n, l->numbers, NULL, l->states) != GRAINLAW_OK ||
      grainlaw_points_save_trials(l->set, n, l->numbers, 0, NULL, l->trials) != GRAINLAW_OK)
    n = 0;
  size_t fits = 0;
  l->needed = sizeof(struct head);
  for (size_t k = 0; k < n; ++k) {
    l->needed += sizeof(struct slot) +
                 room_of(l, l->states[k + 1] - l->states[k], l->trials[k + 1] - l->trials[k]);
    if (l->needed <= l->room) fits = k + 1;
  }
  for (size_t k = fits; k < l->offered; ++k)
    l->order[l->kept++] = (struct point){l->seconds[l->numbers[k]], l->numbers[k]};
  l->offered = fits;
}

static struct slot* slot_of(const grainlaw_lending* l, size_t offered) {
  return (struct slot*)(l->memory + sizeof(struct head)) + (l->offered - 1 - offered);
}

/* Writes the offered points to the window and opens it. */
static void offer(grainlaw_lending* l, const struct call* call) {
  const double start = processor_time();
  struct head* const head = (struct head*)l->memory;
  size_t at = sizeof *head + l->offered * sizeof(struct slot);
  double left = 0;
  for (size_t k = l->offered; k-- > 0;) {
    const size_t point = l->numbers[k];
    size_t state[2] = {0, l->states[k + 1] - l->states[k]};
    size_t trial[2] = {0, l->trials[k + 1] - l->trials[k]};
    struct slot* const slot = slot_of(l, k);
    *slot = (struct slot){.at = (int64_t)at,
                          .room = (int64_t)room_of(l, state[1], trial[1]),
                          .state = (int64_t)state[1],
                          .trial = (int64_t)trial[1],
                          .want = call->want,
                          .material = l->material_of == NULL ? 0 : l->material_of[point],
                          .left = left};
    char* const bytes = l->memory + at;
    const size_t numbers = l->square * sizeof(double);
    memcpy(bytes, call->F + point * l->square, numbers);
    grainlaw_points_save_some(l->set, 1, &point, bytes + numbers, state);
    grainlaw_points_save_trials(l->set, 1, &point, 0, bytes + numbers + state[1], trial);
    at += (size_t)slot->room;
    left += l->seconds[point];
  }
  memset(l->own, 0, l->offered);
  head->next = (int64_t)l->offered;
  MPI_Win_sync(l->window);
  MPI_Accumulate(&l->evaluation, 1, MPI_INT64_T, l->rank, offsetof(struct head, open), 1,
                 MPI_INT64_T, MPI_REPLACE, l->window);
  MPI_Win_flush(l->rank, l->window);
  const double took = processor_time() - start;
  l->count.packing += took;
  l->count.offered += (long)l->offered;
  least_of(&l->packs, took, l->offered);
}

/* ---- what is taken -------------------------------------------------------------------------- */

/* A number of a rank's head, as it was before the change. */
static int64_t ask(grainlaw_lending* l, int rank, size_t place, int64_t change) {
  int64_t found = 0;
  MPI_Fetch_and_op(&change, &found, MPI_INT64_T, rank, (MPI_Aint)place,
                   change == 0 ? MPI_NO_OP : MPI_SUM, l->window);
  MPI_Win_flush(rank, l->window);
  return found;
}

/* The number of the next slot of a rank; below 0: none is left. */
static int64_t take(grainlaw_lending* l, int rank) {
  return ask(l, rank, offsetof(struct head, next), -1) - 1;
}

static void get(grainlaw_lending* l, int rank, void* to, size_t size, size_t at) {
  MPI_Get(to, (int)size, MPI_BYTE, rank, (MPI_Aint)at, (int)size, MPI_BYTE, l->window);
  MPI_Win_flush(rank, l->window);
}

static void put(grainlaw_lending* l, int rank, const void* from, size_t size, size_t at) {
  MPI_Put(from, (int)size, MPI_BYTE, rank, (MPI_Aint)at, (int)size, MPI_BYTE, l->window);
  MPI_Win_flush(rank, l->window);
}

/* Evaluates the point in l->buffer and writes the answer there. Returns its size; 0: it has no room, or
 * could not be read. */
static size_t evaluate_other(grainlaw_lending* l, const struct slot* slot, double* seconds) {
  grainlaw_points* const set = l->others[slot->material];
  const size_t numbers = l->square * sizeof(double), at = numbers + (size_t)slot->state;
  const size_t state[2] = {0, (size_t)slot->state}, trial[2] = {0, (size_t)slot->trial};
  char* const bytes = l->buffer;
  double F[9], P[9], A[81];
  memcpy(F, bytes, numbers);
  if (grainlaw_points_load_some(set, 1, NULL, bytes + numbers, state, NULL, 0) != GRAINLAW_OK ||
      grainlaw_points_load_trials(set, 1, NULL, bytes + at, trial, NULL, 0) != GRAINLAW_OK)
    return 0;
  struct answer answer = {
      .done = 1, .summary = grainlaw_summary_default(), .report = grainlaw_report_default()};
  const double start = processor_time();
  answer.status = grainlaw_points_evaluate_some(set, 1, NULL, F, 0, (unsigned)slot->want, P, 0,
                                                slot->want == 0 ? NULL : A, 0, NULL, &answer.report,
                                                1, &answer.summary);
  *seconds = processor_time() - start;
  size_t sizes[2];
  const size_t tangent = slot->want == 0 ? 0 : numbers * l->square;
  const size_t behind = sizeof answer + numbers + tangent;
  if (grainlaw_points_save_trials(set, 1, NULL, 1, NULL, sizes) != GRAINLAW_OK ||
      behind + sizes[1] > (size_t)slot->room ||
      grainlaw_points_save_trials(set, 1, NULL, 1, bytes + behind, sizes) != GRAINLAW_OK)
    return 0;
  answer.trial = (int64_t)sizes[1];
  memcpy(bytes, &answer, sizeof answer);
  memcpy(bytes + sizeof answer, P, numbers);
  memcpy(bytes + sizeof answer + numbers, A, tangent);
  return behind + sizes[1];
}

static void evaluate_slot(grainlaw_lending* l, int rank, int64_t number) {
  const double start = processor_time();
  double seconds = 0;
  struct slot slot;
  get(l, rank, &slot, sizeof slot, sizeof(struct head) + (size_t)number * sizeof slot);
  l->left[rank] = slot.left;
  const size_t going = l->square * sizeof(double) + (size_t)(slot.state + slot.trial);
  size_t coming = 0;
  if ((size_t)slot.room <= l->buffer_size || resized(&l->buffer, (size_t)slot.room, 1)) {
    if ((size_t)slot.room > l->buffer_size) l->buffer_size = (size_t)slot.room;
    get(l, rank, l->buffer, going, (size_t)slot.at);
    coming = evaluate_other(l, &slot, &seconds);
  }
  static const struct answer none = {0};
  if (coming > 0)
    put(l, rank, l->buffer, coming, (size_t)slot.at);
  else
    put(l, rank, &none, sizeof none, (size_t)slot.at);
  l->count.taken += coming > 0;
  l->count.bytes += (double)(going + coming);
  l->count.seconds += seconds;
  l->count.carrying += processor_time() - start - seconds;
}

/* The rank with most left of those that were not asked in this round; -1: none. */
static int rank_with_most(const grainlaw_lending* l, int64_t round) {
  int most = -1;
  for (int r = 0; r < l->ranks; ++r)
    if (l->left[r] > 0 && l->asked[r] < round && (most < 0 || l->left[r] > l->left[most])) most = r;
  return most;
}

static int offers(grainlaw_lending* l, int rank) {
  if (l->opened[rank] != l->evaluation)
    l->opened[rank] = ask(l, rank, offsetof(struct head, open), 0);
  return l->opened[rank] == l->evaluation;
}

/* Evaluates points of other ranks until none is left. */
static void help(grainlaw_lending* l) {
  const double mean = mean_of_ranks(l);
  for (int r = 0; r < l->ranks; ++r) {
    const double seconds = l->all[r].seconds;
    l->left[r] = r == l->rank || seconds <= own_share * mean ? 0 : seconds;
    l->asked[r] = 0;
  }
  for (int64_t round = 1; rank_with_most(l, round) >= 0; ++round) {
    int64_t number = -1;
    for (int rank; number < 0 && (rank = rank_with_most(l, round)) >= 0;) {
      l->asked[rank] = round;
      if (!offers(l, rank)) continue;
      number = take(l, rank);
      if (number < 0)
        l->left[rank] = 0;
      else
        evaluate_slot(l, rank, number);
    }
  }
}

/* ---- what comes back ------------------------------------------------------------------------ */

/* The answer in a slot; 0: there is none, or no memory for it. */
static int take_answer(const grainlaw_lending* l, struct call* call, size_t point,
                       const char* bytes) {
  struct answer answer;
  memcpy(&answer, bytes, sizeof answer);
  const size_t numbers = l->square * sizeof(double);
  const size_t tangent = call->want == 0 ? 0 : numbers * l->square;
  const size_t trial[2] = {0, (size_t)answer.trial};
  if (!answer.done) return 0;
  bytes += sizeof answer;
  if (grainlaw_points_load_trials(l->set, 1, &point, bytes + numbers + tangent, trial, NULL, 0) !=
      GRAINLAW_OK)
    return 0;
  if (answer.status == GRAINLAW_OK) {
    if (call->P != NULL) memcpy(call->P + point * l->square, bytes, numbers);
    if (tangent > 0) memcpy(call->A + point * l->square * l->square, bytes + numbers, tangent);
  }
  if (call->statuses != NULL) call->statuses[point] = (grainlaw_status)answer.status;
  if (call->reports != NULL) copy_out(&answer.report, report_at(call, point));
  add(call, point, (grainlaw_status)answer.status, &answer.summary);
  return 1;
}

static void take_answers(grainlaw_lending* l, struct call* call) {
  const double start = processor_time();
  long lent = 0;
  MPI_Win_sync(l->window);
  for (size_t k = 0; k < l->offered; ++k)
    if (!l->own[k] && take_answer(l, call, l->numbers[k], l->memory + slot_of(l, k)->at)) {
      l->own[k] = 1;
      ++lent;
    }
  const double took = processor_time() - start;
  l->count.lent += lent;
  l->count.packing += took;
  least_of(&l->unpacks, took, (size_t)lent);
  for (size_t k = 0; k < l->offered; ++k)
    if (!l->own[k]) evaluate_own(l, call, l->numbers[k]);
}

/* Lets MPI answer other ranks, where the network does not do it alone. */
static void serve(const grainlaw_lending* l) {
  int arrived = 0;
  if (l->window != MPI_WIN_NULL)
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, l->comm, &arrived, MPI_STATUS_IGNORE);
}

/* ---- calls ---------------------------------------------------------------------------------- */

static void evaluate(grainlaw_lending* l, struct call* call) {
  struct rank mine = {.grows = l->needed > l->room};
  if (call->status == GRAINLAW_OK) grainlaw_points_cost(l->set, l->seconds);
  for (size_t k = 0; k < l->points; ++k) mine.seconds += l->seconds[k];
  MPI_Allgather(&mine, sizeof mine, MPI_BYTE, l->all, sizeof mine, MPI_BYTE, l->comm);
  grow(l);
  ++l->evaluation;
  plan(l);
  fit(l);
  if (l->window != MPI_WIN_NULL) offer(l, call);
  for (size_t k = 0; k < l->kept; ++k) {
    evaluate_own(l, call, l->order[k].number);
    serve(l);
  }
  if (l->window == MPI_WIN_NULL) return;
  for (int64_t number; (number = take(l, l->rank)) >= 0;) {
    const size_t k = l->offered - 1 - (size_t)number;
    l->own[k] = 1;
    evaluate_own(l, call, l->numbers[k]);
  }
  help(l);
  MPI_Barrier(l->comm);
  take_answers(l, call);
}

grainlaw_status grainlaw_lending_evaluate(grainlaw_lending* l, const double* F, unsigned want,
                                          double* P, double* A, grainlaw_status* statuses,
                                          grainlaw_report* reports, grainlaw_summary* summary) {
  if (l == NULL) return GRAINLAW_NULL_POINTER;
  if (l->ranks == 1)
    return grainlaw_points_evaluate(l->set, F, want, P, A, statuses, reports, 0, summary);
  struct call call = {.F = F,
                      .want = A == NULL ? 0 : want,
                      .P = P,
                      .A = want == 0 ? NULL : A,
                      .statuses = statuses,
                      .reports = reports,
                      .found = grainlaw_summary_default()};
  grainlaw_points_share(l->set, 0, NULL, NULL); /* each rank for itself */
  /* A call for no points tells whether the summary is of a known size. */
  const int unknown = grainlaw_points_evaluate_some(l->set, 0, NULL, NULL, 0, 0, NULL, 0, NULL, 0,
                                                    NULL, NULL, 1, summary) != GRAINLAW_OK;
  grainlaw_status checked = reserve(l) ? check(l, &call, want) : GRAINLAW_OUT_OF_MEMORY;
  if (unknown) checked = GRAINLAW_BAD_REPORT;
  if (checked != GRAINLAW_OK) {
    grainlaw_summary why = grainlaw_summary_default();
    /* The library, which refuses the same call, says why. */
    if (checked == GRAINLAW_NULL_POINTER || checked == GRAINLAW_BAD_ARGUMENT)
      grainlaw_points_evaluate(l->set, F, want, NULL, NULL, NULL, NULL, 1, &why);
    refuse(&call, checked, why.message[0] != 0 ? why.message : grainlaw_status_text(checked));
    l->points = 0;
    for (size_t k = 0; statuses != NULL && !unknown && k < grainlaw_points_size(l->set); ++k)
      statuses[k] = checked;
  }
  evaluate(l, &call);
  agree(l, &call);
  grainlaw_points_share(l->set, l->rank, reduce, l);
  if (unknown) return GRAINLAW_BAD_REPORT;
  if (summary != NULL) copy_out(&call.found, summary);
  return call.status;
}

grainlaw_lent grainlaw_lending_count(const grainlaw_lending* l) {
  return l == NULL ? (grainlaw_lent){.size = sizeof(grainlaw_lent)} : l->count;
}

static void release(grainlaw_lending* l) {
  for (size_t k = 0; l->others != NULL && k < l->materials; ++k)
    grainlaw_points_destroy(l->others[k]);
  void* const memory[] = {l->others, l->material_of, l->all,   l->left,    l->opened,
                          l->asked,  l->seconds,     l->order, l->numbers, l->states,
                          l->trials, l->own,         l->buffer};
  for (size_t k = 0; k < sizeof memory / sizeof *memory; ++k) free(memory[k]);
}

void grainlaw_lending_destroy(grainlaw_lending* l) {
  if (l == NULL) return;
  int ended = 0;
  MPI_Finalized(&ended);
  if (!ended) {
    if (l->ranks > 1) grainlaw_points_share(l->set, 0, NULL, NULL);
    if (l->window != MPI_WIN_NULL) {
      MPI_Win_unlock_all(l->window);
      MPI_Win_free(&l->window);
    }
    MPI_Comm_free(&l->comm);
  }
  release(l);
  free(l);
}

static grainlaw_status number_materials(grainlaw_lending* l, const int* material_of) {
  const size_t points = grainlaw_points_size(l->set);
  if (material_of == NULL) return GRAINLAW_OK;
  if (!resized(&l->material_of, points + 1, sizeof *l->material_of)) return GRAINLAW_OUT_OF_MEMORY;
  l->numbered = points;
  for (size_t k = 0; k < points; ++k) {
    if (material_of[k] < 0 || (size_t)material_of[k] >= l->materials) return GRAINLAW_BAD_ARGUMENT;
    l->material_of[k] = material_of[k];
  }
  return GRAINLAW_OK;
}

/* Refuses a material of another dimension than the set's points. */
static grainlaw_status compare_dimension(const grainlaw_lending* l) {
  size_t components = 0;
  const grainlaw_status status =
      grainlaw_points_measure(l->set, GRAINLAW_CAUCHY_STRESS, NULL, &components);
  if (status != GRAINLAW_OK) return status;
  const int same = components == l->square * grainlaw_points_size(l->set);
  return same ? GRAINLAW_OK : GRAINLAW_BAD_ARGUMENT;
}

/* Makes what a rank needs. `mark`: of all materials. */
static grainlaw_status make(grainlaw_lending* l, const grainlaw_material* const* materials,
                            const int* material_of, unsigned long long* mark) {
  const size_t ranks = (size_t)l->ranks;
  const grainlaw_status alive = grainlaw_points_share(l->set, 0, NULL, NULL);
  if (alive != GRAINLAW_OK) return alive;
  if (materials == NULL) return GRAINLAW_NULL_POINTER;
  if (l->materials == 0) return GRAINLAW_BAD_ARGUMENT;
  l->others = calloc(l->materials, sizeof *l->others);
  l->all = calloc(ranks, sizeof *l->all);
  l->left = calloc(ranks, sizeof *l->left);
  l->opened = calloc(ranks, sizeof *l->opened);
  l->asked = calloc(ranks, sizeof *l->asked);
  if (!l->others || !l->all || !l->left || !l->opened || !l->asked) return GRAINLAW_OUT_OF_MEMORY;
  *mark = l->materials;
  for (size_t k = 0; k < l->materials; ++k) {
    unsigned long long fingerprint = 0;
    grainlaw_status status = grainlaw_points_create(materials[k], 1, &l->others[k]);
    const size_t dimension = (size_t)grainlaw_material_dimension(materials[k]);
    l->square = dimension * dimension;
    if (status == GRAINLAW_OK) status = compare_dimension(l);
    if (status == GRAINLAW_OK) status = grainlaw_material_fingerprint(materials[k], &fingerprint);
    if (status != GRAINLAW_OK) return status;
    *mark = *mark * 1099511628211ULL + fingerprint;
  }
  return number_materials(l, material_of);
}

grainlaw_status grainlaw_lending_create(int communicator, grainlaw_points* set, size_t n,
                                        const grainlaw_material* const* materials,
                                        const int* material_of, grainlaw_lending** out,
                                        char* message, size_t message_size) {
  struct call call = {.found = grainlaw_summary_default()};
  int runs = 0;
  MPI_Initialized(&runs);
  if (out == NULL) return GRAINLAW_NULL_POINTER;
  *out = NULL;
  grainlaw_lending made = {.set = set, .materials = n, .window = MPI_WIN_NULL};
  made.count.size = sizeof made.count;
  grainlaw_lending* const handle = malloc(sizeof *handle);
  if (!runs) {
    refuse(&call, GRAINLAW_BAD_ARGUMENT, "MPI is not running");
  } else {
    MPI_Comm_dup(MPI_Comm_f2c(communicator), &made.comm);
    MPI_Comm_rank(made.comm, &made.rank);
    MPI_Comm_size(made.comm, &made.ranks);
    unsigned long long mark = 0, first;
    grainlaw_status status = make(&made, materials, material_of, &mark);
    if (handle == NULL) status = GRAINLAW_OUT_OF_MEMORY;
    if (status != GRAINLAW_OK) refuse(&call, status, grainlaw_status_text(status));
    first = mark;
    MPI_Bcast(&first, 1, MPI_UNSIGNED_LONG_LONG, 0, made.comm);
    if (status == GRAINLAW_OK && first != mark)
      refuse(&call, GRAINLAW_WRONG_MATERIAL,
             "the materials are not those of rank 0: all need the same files and packings");
    agree(&made, &call);
    if (call.status != GRAINLAW_OK) MPI_Comm_free(&made.comm);
  }
  if (message != NULL && message_size > 0)
    snprintf(message, message_size, "%s", call.found.message);
  if (call.status != GRAINLAW_OK) {
    release(&made);
    free(handle);
    return call.status;
  }
  *handle = made;
  if (made.ranks > 1) grainlaw_points_share(set, made.rank, reduce, handle);
  *out = handle;
  return GRAINLAW_OK;
}
