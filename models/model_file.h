#pragma once

#include <functional>
#include <string>
#include <vector>

#include "models/base/config/config.h"

namespace tubetwin {

/// A file of models/ that describes a device or a cell: one that ships with the program, by name,
/// or a user's own.
struct ModelFile {
  std::string path;  ///< As messages name it.
  std::string text;
  bool shipped = false;

  /// The file as a layer of its own.
  ConfigSource Source() const;
};

/// "grippers", "robotiq_2f85" is the shipped models/grippers/robotiq_2f85.toml; a name that ends in
/// ".toml" is a file. `what` ("gripper") is for messages. Throws Error(kMissing) naming the nearest
/// shipped name or the file.
ModelFile OpenModelFile(const std::string& folder, const std::string& name_or_path,
                        const std::string& what);

/// Names of the shipped files of a folder, sorted.
std::vector<std::string> ModelFileNames(const std::string& folder);

/// Numbers of model files have no defaults: structs begin with this, and what still is after
/// reading was not given.
extern const double kNotGiven;

/// Throws Error(kConfig) naming the first number of the visit list that is kNotGiven or text that
/// is empty, and its doc.
void RequireGiven(const std::function<void(ConfigVisitor&)>& visit, const std::string& path);

/// Throws Error(kConfig): what is wrong in a model file, or at a key of it (its place, or the whole
/// table's where the key is not there).
[[noreturn]] void RefuseFile(const std::string& path, const std::string& problem);
[[noreturn]] void RefuseKey(const ConfigSource& source, const std::string& key,
                            const std::string& problem);

}  // namespace tubetwin
