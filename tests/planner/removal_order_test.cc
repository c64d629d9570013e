#include "planner/scene_query/removal_order.h"

#include "tests/support/catch.h"

namespace tubetwin {
namespace {

// Tubes 1 to n; pairs are upper and lower.
TubeScene Scene(int n, const std::vector<std::pair<int, int>>& crossings) {
  TubeScene scene;
  for (int id = 1; id <= n; ++id) {
    scene.tubes.emplace_back();
    scene.tubes.back().id = id;
  }
  for (const auto& [over, under] : crossings) {
    scene.crossings.emplace_back();
    scene.crossings.back().over = over;
    scene.crossings.back().under = under;
  }
  return scene;
}

std::vector<int> Ids(const std::vector<RemovalRank>& ranks) {
  std::vector<int> ids;
  for (const RemovalRank& rank : ranks) ids.push_back(rank.tube);
  return ids;
}

TEST_CASE("A stack is taken from the top", "[unit]") {
  const std::vector<RemovalRank> order = RemovalOrder(Scene(3, {{3, 2}, {2, 1}}));
  CHECK(Ids(order) == std::vector<int>{3, 2, 1});
  CHECK(order[2].blockers == 2);
  CHECK(order[0].released == 0);  // All of them come free anyway.
}

TEST_CASE("Of tubes that hold each other, the one that sets most free comes first", "[unit]") {
  // A ring of 1, 2 and 3; 4 and 5 lie under 3 alone.
  const std::vector<std::pair<int, int>> ring = {{1, 2}, {2, 3}, {3, 1}};
  std::vector<RemovalRank> order = RemovalOrder(Scene(3, ring));
  CHECK(Ids(order) == std::vector<int>{1, 2, 3});
  for (const RemovalRank& rank : order) {
    CHECK(rank.blockers == 2);
    CHECK(rank.released == 2);
  }
  // Two rings that share tube 3: without it everything comes free, without 1 only 2.
  order = RemovalOrder(Scene(5, {{1, 2}, {2, 3}, {3, 1}, {3, 4}, {4, 5}, {5, 3}}));
  CHECK(order.back().released == 4);
  CHECK(Ids(order) == std::vector<int>{1, 4, 2, 5, 3});
  CHECK(order.front().released == 1);
}

TEST_CASE("What lies under a ring comes after the ring", "[unit]") {
  const std::vector<RemovalRank> order = RemovalOrder(Scene(4, {{2, 1}, {2, 3}, {3, 4}, {4, 2}}));
  CHECK(Ids(order) == std::vector<int>{2, 3, 4, 1});
  CHECK(order.back().blockers == 3);
}

TEST_CASE("Two crossings of one pair count twice as covers, once as a blocker", "[unit]") {
  const std::vector<RemovalRank> order = RemovalOrder(Scene(2, {{1, 2}, {1, 2}, {7, 1}}));
  CHECK(order[0].covers == 0);
  CHECK(order[1].covers == 2);
  CHECK(order[1].blockers == 1);
}

}  // namespace
}  // namespace tubetwin
