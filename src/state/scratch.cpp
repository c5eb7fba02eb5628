#include "state/scratch.hpp"

#include <pthread.h>

#include <memory>
#include <new>
#include <utility>

namespace grainlaw::core {

namespace {

// A pthread key. A thread_local object would end the process when memory for registering its
// destructor is short. The key is deleted with the library, which threads may outlive.
template <int D>
class Key {
 public:
  Key()
      : made_(pthread_key_create(&key_, [](void* of) { delete static_cast<Workspace<D>*>(of); }) ==
              0) {}
  ~Key() {
    delete get();
    if (std::exchange(made_, false)) pthread_key_delete(key_);
  }
  Key(const Key&) = delete;
  Key& operator=(const Key&) = delete;

  [[nodiscard]] Workspace<D>* get() const {
    return made_ ? static_cast<Workspace<D>*>(pthread_getspecific(key_)) : nullptr;
  }
  [[nodiscard]] bool set(const Workspace<D>* workspace) const {
    return made_ && pthread_setspecific(key_, workspace) == 0;
  }

 private:
  pthread_key_t key_{};
  bool made_;
};

// Keys are constructed before, and destroyed after, everything that uses them.
[[gnu::init_priority(101)]] Key<2> of_discs;
[[gnu::init_priority(101)]] Key<3> of_spheres;

template <int D>
auto& key() {
  if constexpr (D == 2) {
    return of_discs;
  } else {
    return of_spheres;
  }
}

}  // namespace

template <int D>
Workspace<D>& workspace() {
  if (Workspace<D>* const mine = key<D>().get()) return *mine;
  auto made = std::make_unique<Workspace<D>>();
  if (!key<D>().set(made.get())) throw std::bad_alloc();
  return *made.release();
}

template <int D>
void drop_workspace() noexcept {
  delete key<D>().get();
  static_cast<void>(key<D>().set(nullptr));
}

template Workspace<2>& workspace();
template Workspace<3>& workspace();
template void drop_workspace<2>() noexcept;
template void drop_workspace<3>() noexcept;

}  // namespace grainlaw::core
