#include "planner/pick/rollout_scheduler.h"

#include <algorithm>
#include <iterator>
#include <limits>

#include "models/base/error.h"
#include "models/base/step_timer.h"
#include "models/base/text.h"
#include "planner/scene_query/sweep.h"

namespace tubetwin {
namespace {

constexpr int kSamplesAtOnce = 2;  // A motion that is bad in one of them need not be tried further.
// So many motions are rolled out before their scores limit the next ones, and so much of the
// simulated time is kept from first roll-outs for the samples of the best.
constexpr std::size_t kAtOnce = 6;
constexpr double kKeptForSamples = 0.3;
// The score over the samples of both.
CandidateScore Merged(CandidateScore score, const CandidateScore& more) {
  const double n = static_cast<double>(score.samples.size());
  const double m = static_cast<double>(more.samples.size());
  const auto mean = [&](double a, double b) { return n + m > 0.0 ? (n * a + m * b) / (n + m) : a; };
  score.displacement_m = mean(score.displacement_m, more.displacement_m);
  score.extra_probability = mean(score.extra_probability, more.extra_probability);
  score.cost =
      std::max(mean(score.cost, more.cost), score.displacement_m + score.extra_probability);
  if (more.status != CandidateScore::Status::kDone) score.status = more.status;
  score.lower_bound = score.lower_bound || more.lower_bound;
  score.sim_s += more.sim_s;
  score.wall_s += more.wall_s;
  score.samples.insert(score.samples.end(), more.samples.begin(), more.samples.end());
  return score;
}

// `score` null: before the simulator is asked.
Rank RankOf(const Scored& scored, const CandidateScore* score) {
  const bool free = scored.target->tube->tube_class == TubeClass::kFree;
  return RankOf(free, !scored.target->doubt.empty(), score);
}

}  // namespace

Rank RankOf(bool free, bool doubtful, const CandidateScore* score) {
  if (score != nullptr && score->status == CandidateScore::Status::kJammed) return Rank::kJams;
  if (!doubtful) return free ? Rank::kCertainFree : Rank::kCertainCovered;
  return free ? Rank::kDoubtfulFree : Rank::kDoubtfulCovered;
}

double ExtraProbability(const CandidateScore& score, const Part& part) {
  if (score.status == CandidateScore::Status::kPruned) return 0.0;
  const PartSearch& fitted = part.search;
  const bool sheds = ShedsByTilting(score);
  const double expected =
      sheds ? fitted.extra_after_shedding
            : std::clamp(fitted.extra_per_m * (score.displacement_m - fitted.extra_quiet_m),
                         fitted.extra_min, fitted.extra_max);
  const double weight = part.is_hose() && !sheds ? fitted.extra_prior_samples : 1.0;
  const double n = static_cast<double>(score.samples.size());
  return (n * score.extra_probability + weight * expected) / (n + weight);
}

RolloutScheduler::RolloutScheduler(const SearchInput& input, const std::vector<Target>& targets,
                                   PlanResult& result)
    : input_(input),
      targets_(targets),
      result_(result),
      max_simulated_s_(
          config().max_simulated_s * (input.problem.part.is_hose() ? 1.0 : config().budget_rigid) *
          config().budget_tubes / std::max<std::size_t>(input.problem.scene.tubes.size(), 1)) {}

bool RolloutScheduler::Exhausted() {
  return next_ == targets_.size() && NextWithout(had_second_) == nullptr &&
         NextWithout(had_last_) == nullptr;
}

bool RolloutScheduler::Next() {
  if (Exhausted()) return false;
  do {
    ScoreMore();
    Refine();
  } while (!Exhausted() && !AnyPromising() && simulated_s_ < max_simulated_s_);
  return true;
}

void RolloutScheduler::Finish() {
  EvaluationResult& out = result_.evaluation;
  for (Scored& scored : scored_) out.candidates.push_back(std::move(scored.score));
  for (std::size_t k = 0; k < out.candidates.size(); ++k) {
    if (out.best < 0 || out.candidates[k].cost < out.candidates[out.best].cost) {
      out.best = static_cast<int>(k);
    }
  }
}

void RolloutScheduler::ScoreMore() {
  if (next_ == targets_.size()) AddLongList();
  while (next_ < targets_.size() && static_cast<int>(waiting_.size()) < config().max_candidates) {
    AddMotions(targets_[next_++], ExtractionMotion::Tier::kFirst);
  }
  ScreenWaiting();
}

// The best tube that is not among those that had a list; null: none is to have it any more.
const Target* RolloutScheduler::NextWithout(const std::vector<const Target*>& had) {
  if (static_cast<int>(had.size()) >= config().separated) return nullptr;
  for (const Scored* scored : InOrder()) {
    if (std::find(had.begin(), had.end(), scored->target) == had.end()) return scored->target;
  }
  return nullptr;
}

void RolloutScheduler::AddLongList() {
  if (const Target* second = NextWithout(had_second_)) {
    had_second_.push_back(second);
    AddMotions(*second, ExtractionMotion::Tier::kSecond);
  } else if (const Target* last = NextWithout(had_last_)) {
    had_last_.push_back(last);
    AddMotions(*last, ExtractionMotion::Tier::kLast);
  }
}

void RolloutScheduler::AddMotions(const Target& target, ExtractionMotion::Tier tier) {
  const PickProblem& problem = input_.problem;
  const auto report = [this](const std::vector<Rejection>& rejections) {
    result_.rejections.insert(result_.rejections.end(), rejections.begin(), rejections.end());
  };
  MotionSet set = MakeMotions(problem.motions, tier, problem.extraction(*target.tube));
  report(set.rejections);
  for (CandidateMotion& motion : set.motions) {
    result_.candidates.push_back(motion);
    GraspSet grasps =
        RankGrasps(problem.grasps(), target.sites, *target.tube, motion, 0.0, input_.top_m);
    if (grasps.grasps.empty()) {
      report(grasps.rejections);
      report({{target.tube->id, motion.name, "", "no grasp suits this motion"}});
      continue;
    }
    const int touches = CountTouched(problem.scene, motion);
    waiting_.push_back({&target, std::move(motion), std::move(grasps.grasps), touches});
  }
}

// Whether a motion of that name is among them, for the same tube.
bool RolloutScheduler::HasOf(const Waiting& waiting, const std::vector<Scored>& among) {
  return std::any_of(among.begin(), among.end(), [&](const Scored& scored) {
    return scored.target == waiting.target && scored.motion.name == waiting.motion.name;
  });
}

// Takes from the waiting motions those that are rolled out together, with the displacement up to
// which each is worth it. One that sheds by tilting takes as long as a wave of others: it is one.
std::vector<Scored> RolloutScheduler::NextWave(std::size_t& next, std::vector<double>& give_up_m) {
  const std::vector<Scored*> order = InOrder();
  // With one sample there is no second question that could set a wrong one right.
  const Scored* rival =
      config().samples > 1 && order.size() >= static_cast<std::size_t>(config().refined)
          ? order[config().refined - 1]
          : nullptr;
  std::vector<Scored> wave;
  const auto full = [&] {
    return wave.size() == kAtOnce || (!wave.empty() && ShedsByTilting(wave.back().motion));
  };
  for (; next < waiting_.size() && !full(); ++next) {
    Waiting& waiting = waiting_[next];
    if (HasOf(waiting, wave) || HasOf(waiting, scored_)) continue;  // A variant of the same.
    if (!wave.empty() && ShedsByTilting(waiting.motion)) break;
    const GraspChoice::Choice choice = input_.choice.FirstRunnable(waiting.motion, waiting.grasps);
    result_.rejections.insert(result_.rejections.end(), choice.rejections.begin(),
                              choice.rejections.end());
    if (!choice.grasp) continue;
    wave.push_back(
        {waiting.target, std::move(waiting.motion), choice.grasp->at_m, choice.grasp->cost, {}, 0});
    give_up_m.push_back(rival != nullptr ? WorthUpTo(wave.back(), *rival)
                                         : std::numeric_limits<double>::infinity());
  }
  return wave;
}

void RolloutScheduler::ScreenWaiting() {
  std::stable_sort(waiting_.begin(), waiting_.end(), [&](const Waiting& a, const Waiting& b) {
    const bool doubtful_a = !a.target->doubt.empty(), doubtful_b = !b.target->doubt.empty();
    return doubtful_a != doubtful_b ? doubtful_b : a.touches < b.touches;
  });
  std::size_t next = 0;
  while (next < waiting_.size() &&
         (scored_.empty() || simulated_s_ < (1.0 - kKeptForSamples) * max_simulated_s_)) {
    std::vector<double> give_up_m;
    std::vector<Scored> wave = NextWave(next, give_up_m);
    const std::size_t first = scored_.size();
    std::move(wave.begin(), wave.end(), std::back_inserter(scored_));
    std::vector<Scored*> asked;
    for (std::size_t k = first; k < scored_.size(); ++k) asked.push_back(&scored_[k]);
    AddSamples(asked, 1, give_up_m);
  }
  for (; next < waiting_.size(); ++next) {
    if (HasOf(waiting_[next], scored_)) continue;
    const CandidateMotion& motion = waiting_[next].motion;
    result_.rejections.push_back({motion.tube, motion.name, "",
                                  "not rolled out: the " + Number(max_simulated_s_) +
                                      " s of planner.max_simulated_s are spent"});
  }
  waiting_.clear();
}

void RolloutScheduler::Refine() {
  for (;;) {
    std::vector<Scored*> order = InOrder();
    if (order.empty() || IsRefined(*order.front())) return;
    if (simulated_s_ >= max_simulated_s_) return;
    // What is left to score is asked about before a motion that cannot promise anything.
    if (!Exhausted() && !MayPromise(*order.front())) return;
    order.resize(std::min<std::size_t>(order.size(), config().refined));
    std::erase_if(order, [this](const Scored* scored) { return IsRefined(*scored); });
    // Those with as many samples as the best: one question for all.
    const int samples = order.front()->samples;
    std::erase_if(order, [&](const Scored* scored) { return scored->samples != samples; });
    AddSamples(order, std::min(kSamplesAtOnce, config().samples - samples));
  }
}

std::vector<Scored*> RolloutScheduler::InOrder() {
  std::vector<Scored*> order;
  for (Scored& scored : scored_) order.push_back(&scored);
  std::stable_sort(order.begin(), order.end(), [this](const Scored* a, const Scored* b) {
    const Rank rank_a = RankOf(*a, &a->score), rank_b = RankOf(*b, &b->score);
    return rank_a != rank_b ? rank_a < rank_b : CostOf(*a, a->score) < CostOf(*b, b->score);
  });
  return order;
}

bool RolloutScheduler::IsRefined(const Scored& scored) const {
  return scored.score.status != CandidateScore::Status::kDone || scored.samples >= config().samples;
}

// To take its tube alone.
bool RolloutScheduler::Promises(const CandidateScore& score) const {
  return ExtraProbability(score, input_.problem.part) <= config().accept_extra;
}

// Whether it would promise if it took its tube alone in all samples to come.
bool RolloutScheduler::MayPromise(const Scored& scored) const {
  CandidateScore score = scored.score;
  const double known = static_cast<double>(score.samples.size());
  score.samples.resize(std::max<std::size_t>(score.samples.size(), config().samples));
  score.extra_probability *= known / static_cast<double>(score.samples.size());
  return Promises(score);
}

double RolloutScheduler::CostOf(const Scored& scored, const CandidateScore& score) const {
  const double share = std::min(score.displacement_m / config().max_displacement_m, 1.0);
  return scored.grasp_cost + config().weight_trajectory * share + scored.target->cost +
         config().weight_extra * ExtraProbability(score, input_.problem.part);
}

// The displacement with which the first roll-out of a motion makes it dearer than a rival.
double RolloutScheduler::WorthUpTo(const Scored& scored, const Scored& rival) const {
  constexpr int kHalvings = 20;
  const Rank own = RankOf(scored, nullptr), other = RankOf(rival, &rival.score);
  if (own < other) return std::numeric_limits<double>::infinity();
  if (other < own) return 0.0;
  CandidateScore score;
  score.samples.resize(1);
  const auto worth = [&](double displacement_m) {
    score.displacement_m = displacement_m;
    return CostOf(scored, score) <= CostOf(rival, rival.score);
  };
  double low_m = 0.0, high_m = config().max_displacement_m;
  if (worth(high_m)) return std::numeric_limits<double>::infinity();
  for (int k = 0; k < kHalvings; ++k) {
    const double middle_m = 0.5 * (low_m + high_m);
    (worth(middle_m) ? low_m : high_m) = middle_m;
  }
  return low_m;
}

bool RolloutScheduler::AnyPromising() const {
  return std::any_of(scored_.begin(), scored_.end(), [this](const Scored& scored) {
    return scored.target->doubt.empty() && IsRefined(scored) &&
           (scored.score.status == CandidateScore::Status::kDone ||
            scored.score.status == CandidateScore::Status::kPruned) &&
           Promises(scored.score);
  });
}

void RolloutScheduler::AddSamples(const std::vector<Scored*>& motions, int samples,
                                  const std::vector<double>& give_up_m) {
  if (motions.empty()) return;
  TT_CHECK(input_.evaluate);
  EvaluationRequest request;
  request.seed = input_.seed;
  request.first_sample = motions.front()->samples;
  request.samples = samples;
  request.give_up_m = give_up_m;
  for (const Scored* scored : motions) {
    request.candidates.push_back(scored->motion);
    request.grasp_at_m.push_back(scored->grasp_at_m);
  }
  const double start_s = WallClock_s();
  const EvaluationResult answer =
      input_.evaluate(input_.problem.scene, input_.problem.part, input_.problem.bin, request);
  TT_CHECK(answer.candidates.size() == motions.size());
  result_.evaluator_s += WallClock_s() - start_s;
  result_.evaluation.settle_s += answer.settle_s;
  result_.evaluation.wall_s += answer.wall_s;
  result_.evaluation.threads = answer.threads;
  for (std::size_t k = 0; k < motions.size(); ++k) {
    Scored& scored = *motions[k];
    scored.score =
        scored.samples == 0 ? answer.candidates[k] : Merged(scored.score, answer.candidates[k]);
    simulated_s_ += answer.candidates[k].sim_s;
    // What was given up for others' sake starts anew should it come to the front.
    const bool ours = !give_up_m.empty() && answer.candidates[k].lower_bound &&
                      answer.candidates[k].displacement_m > give_up_m[k];
    if (!ours) scored.samples += samples;
  }
}

}  // namespace tubetwin
