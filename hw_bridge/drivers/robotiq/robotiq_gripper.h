#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "hw_bridge/cell/devices.h"
#include "hw_bridge/codecs/robotiq_registers.h"
#include "hw_bridge/drivers/robotiq/robotiq_config.h"

namespace tubetwin {

class ModbusClient;

/// A Robotiq 2F gripper by Modbus RTU or TCP. A thread of its own polls it 100 times per second of
/// cell time (500 of wall time at most); the methods only take a lock. Never sends what nobody has
/// commanded: faults and the destructor leave the fingers as they are.
///
/// State().time is when the newest status came. A request is kMoving until the gripper has told
/// otherwise for this very request. A gripper that follows a request which is not this driver's is
/// somebody else's: State().problem says so from then on, for good. A link that is closed, or
/// silent for 1 s, is lost for good: State() keeps the last status with fault 0x09, commands go
/// nowhere.
class RobotiqGripper : public Gripper {
 public:
  /// Connects and, where the gripper is not activated or in a major fault, activates it: the
  /// fingers open and close. Fingers that are neither closed nor wide open may hold something: that
  /// needs a person's word (config.confirm). At most 8 s (of cell time where that is slower than
  /// the wall's) besides the time that a person takes. `clock` must outlive it and tell Now() to
  /// any thread. Throws Error(kConfig), and Error(kDevice) naming device, place and what was
  /// awaited.
  RobotiqGripper(const RobotiqConfig& config, const CellClock& clock);
  ~RobotiqGripper() override;

  /// Precondition: finite numbers.
  void Command(const GripperCommand& command) override;
  GripperState State() const override;

  /// Why the link is lost; empty: it is not.
  std::string LinkProblem() const;
  /// Polls and commands that got no answer that could be used, so far.
  int unanswered() const;

 private:
  void Connect();
  void RequireEmptyFingers(const GripperStatus& status) const;
  void Activate(std::chrono::steady_clock::time_point deadline);
  GripperStatus AwaitStatus(std::chrono::steady_clock::time_point deadline);
  void Serve(const std::stop_token& stop);
  /// One turn: what is commanded is written, the status is read. False: the link is lost.
  bool Exchange();
  bool Heard(bool answered, bool lost);
  void Take(const GripperStatus& status);
  void JudgeRequest(const GripperStatus& status);
  void Lose(const std::string& problem);

  RobotiqConfig config_;
  const CellClock& clock_;
  /// What the gripper says that it was told.
  struct Request {
    bool go_to = false;
    std::uint8_t position = 0;
    bool operator==(const Request&) const = default;
  };
  std::unique_ptr<ModbusClient> client_;                   ///< Of the thread, once it runs.
  std::chrono::steady_clock::time_point heard_, written_;  ///< Of the thread.

  mutable std::mutex mutex_;  ///< Of all below but the thread.
  std::condition_variable_any commanded_;
  GripperAction action_;    ///< The newest command.
  bool fresh_ = false;      ///< Nobody has tried to write it.
  bool pending_ = false;    ///< It has not been written.
  bool unsettled_ = false;  ///< The gripper has not told of it.
  bool ever_ = false;       ///< There was one.
  GripperState state_;
  std::optional<Request> sent_;  ///< Newest that was written, or may have been.
  std::optional<Request> told_;  ///< Newest that the gripper told and should have.
  int foreign_ = 0;              ///< Statuses in a row that tell of another.
  std::string lost_;
  int unanswered_ = 0;

  std::jthread thread_;  ///< Last: ends before what it uses.
};

}  // namespace tubetwin
