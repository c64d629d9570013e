#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planner/pick/grasp_choice.h"
#include "planner/pick/pick_plan.h"

namespace tubetwin {

/// Order of preference; within a rank the cost decides.
enum class Rank { kCertainFree, kCertainCovered, kDoubtfulFree, kDoubtfulCovered, kJams };
/// `score` null: the simulator was not asked.
Rank RankOf(bool free, bool doubtful, const CandidateScore* score);

/// A tube that can be grasped, with what was found out about it once.
struct Target {
  const PerceivedTube* tube = nullptr;
  std::string doubt;  ///< Why it comes late; empty: for no reason.
  double cost = 0.0;  ///< Of taking this tube, whatever the motion.
  GraspSites sites;
};

/// A motion of a covered tube and what the evaluator says of it.
struct Scored {
  const Target* target = nullptr;
  CandidateMotion motion;
  double grasp_at_m = 0.0, grasp_cost = 0.0;  ///< The best grasp with which the arm can run it.
  CandidateScore score;
  int samples = 0;  ///< That were asked for and not given up.
};

/// Probability that another tube comes along: the samples' share drawn towards what the predicted
/// displacement says (after a motion that sheds by tilting: towards a constant), which counts as
/// some samples (the part's own numbers). A motion that touches nothing: 0.
double ExtraProbability(const CandidateScore& score, const Part& part);

/// What a search needs to know; all must outlive it.
struct SearchInput {
  const PickProblem& problem;
  const EvaluateFunction& evaluate;
  GraspChoice& choice;
  std::uint64_t seed = 1;
  double top_m = 0.0;  ///< Of the highest tube.
};

/// Scores motions of covered tubes in the order of `targets`, in batches of about `max_candidates`:
/// those of the registry's first tier of every tube, then those of the second, a tube at a time,
/// for the `separated` best, then those of the last likewise. Each motion is rolled out once, those
/// that touch the fewest tubes first, as far as it may still be among the best `refined`; then
/// these with all samples, until the best of all has them: one lucky roll-out wins too easily among
/// many. A best motion that cannot promise anything waits with its samples until all have been
/// rolled out once. What the arm cannot run is not rolled out. Candidates, rejections and times go
/// into the result.
class RolloutScheduler {
 public:
  RolloutScheduler(const SearchInput& input, const std::vector<Target>& targets,
                   PlanResult& result);

  /// Goes on until a motion promises to take its tube alone (`accept_extra`), nothing is left to
  /// score or the simulated time is spent: `max_simulated_s` with seven hoses; of fewer more in
  /// proportion and of rigid tubes thrice as much, for these are simulated as much faster. False
  /// when nothing was left before.
  bool Next();
  const std::vector<Scored>& scored() const { return scored_; }
  /// Moves the scores into the result.
  void Finish();

 private:
  /// To be rolled out for the first time.
  struct Waiting {
    const Target* target = nullptr;
    CandidateMotion motion;
    std::vector<Grasp> grasps;  ///< That suit it, cheapest first.
    int touches = 0;            ///< Other tubes, by its swept volume.
  };

  bool Exhausted();
  const PlannerConfig& config() const { return input_.problem.config; }
  static bool HasOf(const Waiting& waiting, const std::vector<Scored>& among);
  const Target* NextWithout(const std::vector<const Target*>& had);
  void ScoreMore();
  void AddLongList();
  void AddMotions(const Target& target, ExtractionMotion::Tier tier);
  void ScreenWaiting();
  std::vector<Scored> NextWave(std::size_t& next, std::vector<double>& give_up_m);
  void Refine();
  std::vector<Scored*> InOrder();
  bool IsRefined(const Scored& scored) const;
  bool Promises(const CandidateScore& score) const;
  bool MayPromise(const Scored& scored) const;
  double CostOf(const Scored& scored, const CandidateScore& score) const;
  double WorthUpTo(const Scored& scored, const Scored& rival) const;
  bool AnyPromising() const;
  void AddSamples(const std::vector<Scored*>& motions, int samples,
                  const std::vector<double>& give_up_m = {});

  const SearchInput input_;
  const std::vector<Target>& targets_;
  PlanResult& result_;
  const double max_simulated_s_;
  std::size_t next_ = 0;
  std::vector<const Target*> had_second_, had_last_;  ///< Targets that had motions of those tiers.
  double simulated_s_ = 0.0;
  std::vector<Waiting> waiting_;
  std::vector<Scored> scored_;
};

}  // namespace tubetwin
