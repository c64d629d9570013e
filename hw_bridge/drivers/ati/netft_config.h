#pragma once

#include <string>

#include "models/base/config/config.h"

namespace tubetwin {

/// How to reach an ATI Net F/T box: `[cell.wrist]` of a cell file.
struct NetftConfig {
  std::string host = "192.168.1.1";  ///< Factory address of the box.
  int port = 49152;                  ///< UDP, raw data transfer.
  /// TCP, the box's configuration page; 0: it is not read and the counts below are believed.
  int http_port = 8049;
  double counts_per_N = 1e6, counts_per_Nm = 1e6;  ///< The page must say the same.
  /// Cell time per wall time: of the whole cell, so the cell file's own key and not visited here.
  double rate = 1.0;

  void Visit(ConfigVisitor& v);
  /// Throws Error(kConfig) for what the fields' own ranges cannot say.
  void ValidateOrThrow() const;
  /// "force/torque sensor 127.0.0.1:49152", for messages.
  std::string Name() const;
};

}  // namespace tubetwin
