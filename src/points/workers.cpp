#include "points/workers.hpp"

#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdlib>
#include <mutex>
#include <new>
#include <string_view>
#include <system_error>
#include <thread>

namespace grainlaw::core {

namespace {

// Work of one call, in a list of all calls.
struct Job {
  const std::function<void()>& work;
  int vacancies;   // helpers that may still come
  int inside = 0;  // helpers that are working
  Job* next = nullptr;
};

// Shared state of the threads, guarded by the mutex. No member has a destructor, since threads may
// outlive the library's static objects.
struct Crew {
  std::mutex mutex;
  pthread_cond_t called = PTHREAD_COND_INITIALIZER;
  pthread_cond_t left = PTHREAD_COND_INITIALIZER;
  Job* jobs = nullptr;
  int vacancies = 0;  // sum over all jobs
  int size = 0;       // threads
  int busy = 0;       // threads at work
  bool dismissed = false;
  std::array<pthread_t, most_threads> threads{};
};

constinit Crew crew;

void* help(void* /*unused*/) {
  std::unique_lock lock(crew.mutex);
  while (!crew.dismissed) {
    Job* job = crew.jobs;
    while (job != nullptr && job->vacancies == 0) job = job->next;
    if (job == nullptr) {
      pthread_cond_wait(&crew.called, crew.mutex.native_handle());
      continue;
    }
    --job->vacancies;
    --crew.vacancies;
    ++job->inside;
    ++crew.busy;
    lock.unlock();
    job->work();
    lock.lock();
    --crew.busy;
    if (--job->inside == 0) pthread_cond_broadcast(&crew.left);
  }
  return nullptr;
}

// Blocks the host's signals in the threads; synchronous faults stay enabled.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
    for (const int fault : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP, SIGPROF})
      sigdelset(&all, fault);
    pthread_sigmask(SIG_SETMASK, &all, &host_);
  }
  ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &host_, nullptr); }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t host_;
};

// Resets the crew in a child of fork, which has no threads and an undefined mutex.
void forget_in_children() { new (&crew) Crew; }

bool start_one() {
  static bool survives_fork = false;
  if (!survives_fork) survives_fork = pthread_atfork(nullptr, nullptr, forget_in_children) == 0;
  if (!survives_fork || crew.size == most_threads) return false;
  const SignalsBlocked blocked;
  pthread_t& thread = crew.threads[static_cast<std::size_t>(crew.size)];
  if (pthread_create(&thread, nullptr, help, nullptr) != 0) return false;
  ++crew.size;
  return true;
}

// Ends the threads when the library is unloaded, so that none runs its code. At exit threads may
// still work, or have been stopped while they held the mutex.
struct Dismissal {
  ~Dismissal() {
    {
      std::unique_lock lock(crew.mutex, std::try_to_lock);
      for (int wait = 0; !lock && wait < 1000; ++wait) {
        usleep(1000);
        static_cast<void>(lock.try_lock());
      }
      if (!lock || crew.jobs != nullptr) return;
      crew.dismissed = true;
      pthread_cond_broadcast(&crew.called);
    }
    for (int k = 0; k < crew.size; ++k)
      pthread_join(crew.threads[static_cast<std::size_t>(k)], nullptr);
    crew.size = 0;
  }
} dismissal;

}  // namespace

int default_threads() {
  if (const char* const text = std::getenv("OMP_NUM_THREADS")) {
    const std::string_view wanted(text);
    int threads = 0;
    const auto [end, error] =
        std::from_chars(wanted.data(), wanted.data() + wanted.size(), threads);
    if (error == std::errc{} && threads > 0) return threads;
  }
#if defined(__linux__)
  cpu_set_t processors;
  if (sched_getaffinity(0, sizeof processors, &processors) == 0) return CPU_COUNT(&processors);
#endif
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

void work_together(const std::function<void()>& work, int helpers) noexcept {
  Job job{work, helpers};
  if (helpers > 0) {
    const std::lock_guard lock(crew.mutex);
    job.next = crew.jobs;
    crew.jobs = &job;
    crew.vacancies += helpers;
    while (crew.vacancies > crew.size - crew.busy && start_one()) {
    }
    for (int k = 0; k < helpers; ++k) pthread_cond_signal(&crew.called);
  }
  work();
  if (helpers == 0) return;
  std::unique_lock lock(crew.mutex);
  crew.vacancies -= job.vacancies;
  Job** link = &crew.jobs;
  while (*link != &job) link = &(*link)->next;
  *link = job.next;
  while (job.inside > 0) pthread_cond_wait(&crew.left, crew.mutex.native_handle());
}

}  // namespace grainlaw::core
