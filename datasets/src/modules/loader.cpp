// SPDX-License-Identifier: GPL-3.0-or-later
// GDAL, SQLite, MPI and the page's server as modules beside the program, loaded when they are first needed: PREFIX/bin/PROGRAM finds them
// in the library folder of PREFIX, and nowhere else. A library that a foreign program has loaded (the Python extension)
// finds them in its own folder, or where they are installed or were built.
#include <dlfcn.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/input_text.h"
#include "gdal/vector_library.h"
#include "modules/load.h"
#include "modules/module.h"
#include "mpi/rank_library.h"

namespace exactvo::datasets {
namespace {

namespace fs = std::filesystem;

#ifdef EXACTVO_MODULES_BESIDE_LIBRARY
fs::path module_path(const std::string& name) {
  Dl_info self;
  if (::dladdr(reinterpret_cast<const void*>(&module_path), &self) == 0) return name + ".so";
  const fs::path folder = fs::absolute(self.dli_fname).parent_path();
  for (const char* place : {".", EXACTVO_INSTALLED_MODULE_FOLDER}) {
    std::error_code error;
    const fs::path there = (folder / place / (name + ".so")).lexically_normal();
    if (fs::exists(there, error)) return there;
  }
  return (folder / EXACTVO_MODULE_FOLDER / (name + ".so")).lexically_normal();
}
#else
fs::path module_path(const std::string& name) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return (program.parent_path() / EXACTVO_MODULE_FOLDER / (name + ".so")).lexically_normal();
}
#endif

[[noreturn]] void refuse(const fs::path& module, const std::string& purpose, const std::string& found) {
  throw DataError(DataCode::format_unavailable, module.string(), "", found,
                  "the module for " + purpose + ", installed with this program");
}

/// Never unloaded: what it registers with the process stays.
const void* load(const std::string& name, const std::string& purpose, int visibility) {
  const fs::path path = module_path("exactvo_" + name);
  void* const module = ::dlopen(path.c_str(), RTLD_NOW | visibility);
  if (module == nullptr) {
    std::string words = ::dlerror();
    const std::string prefix = path.string() + ": ";  // of its own file it is said already
    if (words.rfind(prefix, 0) == 0) words.erase(0, prefix.size());
    refuse(path, purpose, "a module that cannot be loaded: " + words);
  }
  auto* const entry = reinterpret_cast<ModuleFunction*>(::dlsym(module, kModuleFunction));
  if (entry == nullptr) refuse(path, purpose, "a library that is no module of ExactVO");
  const ModuleEntry given = entry();
  if (std::string_view(given.build) != kBuild)
    refuse(path, purpose, "the module of another build (" + std::string(given.build) + ")");
  if (given.name != name) refuse(path, purpose, "another module, that of " + std::string(given.name));
  return given.library;
}

}  // namespace

const void* load_module(const std::string& name, const std::string& purpose) {
  return load(name, purpose, RTLD_LOCAL);
}

#ifdef EXACTVO_LOADS_GDAL
const VectorLibrary& vector_library() {
  static const VectorLibrary& library = []() -> const VectorLibrary& {
    const auto& loaded =
        *static_cast<const VectorLibrary*>(load("gdal", "vector files, pictures and GeoPackages (GDAL)", RTLD_LOCAL));
    loaded.set_wait_hook(call_wait_hook);  // the program's: a signal ends the module's readers too
    return loaded;
  }();
  return library;
}
#endif

#ifdef EXACTVO_LOADS_MPI
const RankLibrary& rank_library() {
  // Open MPI loads plugins of its own, which look for its names among those of the whole process.
  static const void* const library = load("mpi", "runs and batches over ranks (MPI)", RTLD_GLOBAL);
  return *static_cast<const RankLibrary*>(library);
}
#endif

}  // namespace exactvo::datasets
