#include "state/scratch.hpp"

#include <pthread.h>

#include <memory>
#include <new>
#include <utility>

namespace grainlaw {

namespace {

// A key, since a thread_local object ends the process where there is no memory to register its
// destructor. It goes with the library, which threads may outlive.
class Key {
 public:
  Key()
      : made_(pthread_key_create(&key_, [](void* of) { delete static_cast<Workspace*>(of); }) ==
              0) {}
  ~Key() {
    delete get();
    if (std::exchange(made_, false)) pthread_key_delete(key_);
  }
  Key(const Key&) = delete;
  Key& operator=(const Key&) = delete;

  [[nodiscard]] Workspace* get() const {
    return made_ ? static_cast<Workspace*>(pthread_getspecific(key_)) : nullptr;
  }
  [[nodiscard]] bool set(const Workspace* workspace) const {
    return made_ && pthread_setspecific(key_, workspace) == 0;
  }

 private:
  pthread_key_t key_{};
  bool made_;
};

// Made before, and gone after, whatever uses it.
[[gnu::init_priority(101)]] Key key;

}  // namespace

Workspace& workspace() {
  if (Workspace* const mine = key.get()) return *mine;
  auto made = std::make_unique<Workspace>();
  if (!key.set(made.get())) throw std::bad_alloc();
  return *made.release();
}

void drop_workspace() noexcept {
  delete key.get();
  static_cast<void>(key.set(nullptr));
}

}  // namespace grainlaw
