#pragma once

#include <memory>
#include <optional>
#include <string>

#include "hw_bridge/cell/cell.h"
#include "hw_bridge/recording/cell_recording.h"
#include "models/base/error.h"

namespace tubetwin {

/// A cell that records another one: its devices hand every call on and write down the call and its
/// answer, in order. What is used through cell() goes into the file; what is done to the inner cell
/// directly does not. Same thread as the inner cell, which must outlive it.
class CellRecorder {
 public:
  /// Layout and bin of `header` are taken from the cell. Throws as CellRecordingWriter does.
  CellRecorder(Cell& inner, CellRecordingHeader header, const std::string& path);
  ~CellRecorder();

  Cell& cell();

  /// What the pipeline is about to do, for people.
  void Caption(const std::string& text);
  /// What something came to, as the pipeline believes: a replay compares it.
  void Result(const std::string& text);
  /// Why nothing is recorded any more: the disk is full. The cell goes on all the same, what was
  /// recorded before can be read, and whoever runs the round should bring it to an end.
  const std::optional<Error>& failure() const;
  /// The round is over: end mark and index. Without it the recording counts as cut short. Throws
  /// failure(), and Error(kIo).
  void Finish(const std::string& reason);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tubetwin
