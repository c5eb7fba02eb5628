#include "fe/mesh/gmsh_library.hpp"

#include "app/library.hpp"

#include <fmt/format.h>

#ifdef GRAINLAW_GMSH_LIBRARY

#include <dlfcn.h>
#include <gmshc.h>

#include <span>
#include <type_traits>

namespace verification {
namespace {

class Gmsh {
 public:
  Gmsh() : handle_(dlopen(GRAINLAW_GMSH_LIBRARY, RTLD_NOW | RTLD_LOCAL)) {
    if (handle_ == nullptr) throw InputError(fmt::format("Gmsh cannot be loaded: {}", dlerror()));
    int error = 0;
    // Later versions have an argument for running the command line.
    const auto initialize = [&](auto* function) {
      if constexpr (std::is_invocable_v<decltype(function), int, char**, int, int*>)
        function(0, nullptr, 0, &error);
      else
        function(0, nullptr, 0, 0, &error);
    };
    initialize(symbol<decltype(&gmshInitialize)>("gmshInitialize"));
    call<decltype(&gmshOptionSetNumber)>("gmshOptionSetNumber", "General.Terminal", 0.0);
  }
  ~Gmsh() {
    int error = 0;
    symbol<decltype(&gmshFinalize)>("gmshFinalize")(&error);
  }
  Gmsh(const Gmsh&) = delete;
  Gmsh& operator=(const Gmsh&) = delete;

  // Calls a function of Gmsh's C interface and supplies its last argument, the error.
  template <class Function, class... Arguments>
  void call(const char* name, Arguments... arguments) const {
    int error = 0;
    symbol<Function>(name)(arguments..., &error);
    if (error == 0) return;
    char* text = nullptr;
    int unused = 0;
    symbol<decltype(&gmshLoggerGetLastError)>("gmshLoggerGetLastError")(&text, &unused);
    const std::string message = text != nullptr ? text : "";
    free(text);
    throw InputError(fmt::format("{} failed: {}", name, message));
  }

  template <class T>
  std::vector<T> take(T* values, std::size_t count) const {
    std::vector<T> result(values, values + count);
    free(values);
    return result;
  }

 private:
  template <class Function>
  Function symbol(const char* name) const {
    void* address = dlsym(handle_, name);
    if (address == nullptr) throw InputError(fmt::format("Gmsh lacks {}", name));
    return reinterpret_cast<Function>(address);
  }
  void free(void* memory) const { symbol<decltype(&gmshFree)>("gmshFree")(memory); }

  void* handle_;  // never closed: Gmsh does not unload cleanly
};

#define GRAINLAW_CALL(function, ...) gmsh.call<decltype(&function)>(#function, __VA_ARGS__)

// Elements of an entity, or of all entities of this dimension (-1).
std::vector<GmshElements> elements(const Gmsh& gmsh, int dimension, int entity) {
  int* types = nullptr;
  std::size_t count = 0;
  GRAINLAW_CALL(gmshModelMeshGetElementTypes, &types, &count, dimension, entity);
  std::vector<GmshElements> result;
  for (const int type : gmsh.take(types, count)) {
    std::size_t *tags = nullptr, *nodes = nullptr;
    std::size_t tag_count = 0, node_count = 0;
    GRAINLAW_CALL(gmshModelMeshGetElementsByType, type, &tags, &tag_count, &nodes, &node_count,
                  entity, std::size_t{0}, std::size_t{1});
    gmsh.take(tags, tag_count);
    if (tag_count == 0) continue;
    result.push_back({type, node_count / tag_count, gmsh.take(nodes, node_count)});
  }
  return result;
}

std::vector<GmshGroup> groups(const Gmsh& gmsh) {
  int* pairs = nullptr;
  std::size_t count = 0;
  GRAINLAW_CALL(gmshModelGetPhysicalGroups, &pairs, &count, -1);
  const std::vector<int> dimension_tags = gmsh.take(pairs, count);
  std::vector<GmshGroup> result;
  for (std::size_t k = 0; k + 1 < dimension_tags.size(); k += 2) {
    const int dimension = dimension_tags[k];
    char* text = nullptr;
    GRAINLAW_CALL(gmshModelGetPhysicalName, dimension, dimension_tags[k + 1], &text);
    GmshGroup group{dimension, text != nullptr ? text : "", {}};
    gmsh.take(text, 0);
    if (group.name.empty()) continue;
    int* tags = nullptr;
    GRAINLAW_CALL(gmshModelGetEntitiesForPhysicalGroup, dimension, dimension_tags[k + 1], &tags,
                  &count);
    for (const int entity : gmsh.take(tags, count))
      for (const GmshElements& part : elements(gmsh, dimension, entity))
        group.elements.push_back(part);
    result.push_back(group);
  }
  return result;
}

}  // namespace

GmshContent read_gmsh(const std::filesystem::path& path) {
  const Gmsh gmsh;
  GRAINLAW_CALL(gmshOpen, path.c_str());
  GmshContent content;
  std::size_t* tags = nullptr;
  double *positions = nullptr, *parameters = nullptr;
  std::size_t tag_count = 0, position_count = 0, parameter_count = 0;
  GRAINLAW_CALL(gmshModelMeshGetNodes, &tags, &tag_count, &positions, &position_count, &parameters,
                &parameter_count, -1, -1, 0, 0);
  content.node_tags = gmsh.take(tags, tag_count);
  gmsh.take(parameters, parameter_count);
  const std::vector<double> flat = gmsh.take(positions, position_count);
  for (std::size_t k = 0; k + 2 < flat.size(); k += 3)
    content.node_positions.push_back({flat[k], flat[k + 1], flat[k + 2]});
  content.elements = elements(gmsh, content.dimension = 3, -1);
  if (content.elements.empty()) content.elements = elements(gmsh, content.dimension = 2, -1);
  content.groups = groups(gmsh);
  return content;
}

}  // namespace verification

#else

namespace verification {

GmshContent read_gmsh(const std::filesystem::path& path) {
  throw InputError(fmt::format(
      "{}: this program was built without Gmsh; expected libgmsh-dev when it was configured",
      path.string()));
}

}  // namespace verification

#endif
