#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "hw_bridge/cell/cell.h"
#include "hw_bridge/recording/cell_recording.h"

namespace tubetwin {

/// Where a replay first asks for something else than was recorded.
struct ReplayDifference {
  std::string kind;      ///< Of the command: "arm start", "gripper command", "result" ...
  TimeNs time{0};        ///< Of the cell.
  std::string field;     ///< "trajectory point 3 of 120, q of joint 2"; "kind" for another command.
  std::string recorded;  ///< What the recording has there.
  std::string asked;     ///< What was asked now.
  std::string after;     ///< The caption that was valid: what the pipeline was about.
  std::uint64_t command = 0;  ///< How many commands agreed before it.
};
/// One line: "at 12.345 s, arm start, ...: recorded 0.1, asked 0.2".
std::string ToString(const ReplayDifference& difference);

/// How a replay went.
struct ReplayTally {
  std::uint64_t commands = 0;    ///< That agreed.
  std::uint64_t reads = 0;       ///< Answered with what was recorded.
  std::uint64_t more_reads = 0;  ///< Asked but not recorded; answered with the newest recorded one.
  std::uint64_t missing_reads = 0;  ///< Recorded but not asked.
  std::optional<ReplayDifference> difference;
  bool ran_out = false;  ///< Everything agreed up to where a cut recording ends.
};

/// Thrown by the devices of a replay when there is nothing to answer: after the first difference,
/// or where a recording that was cut short ends. The tally says which. Leaves the pick cycle. The
/// clock's Now() never throws: it stands still then.
class ReplayOver : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A cell made of a recording: reads are answered with what was read, and every command must be the
/// next recorded command, with the same content, whose answer it then gets. Time passes as it did.
/// Reads are looked for among those before the next recorded command. One thread.
class ReplayCell {
 public:
  explicit ReplayCell(CellRecording recording);
  ~ReplayCell();

  Cell& cell();
  const CellRecordingHeader& header() const;
  const ReplayTally& tally() const;

  /// What the pipeline is about to do; only named in differences.
  void Caption(const std::string& text);
  /// Compared like a command. Throws ReplayOver.
  void Result(const std::string& text);
  /// The pipeline has ended: commands that the recording still has are a difference. Does not
  /// throw ReplayOver.
  void Finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tubetwin
