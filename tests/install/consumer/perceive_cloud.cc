#include <cstdio>

#include "perception/perceive.h"

/// perceive_cloud CLOUD...: how many tubes `pvc_a` lie in the default bin.
int main(int count, char** names) {
  std::vector<tubetwin::OrganizedCloud> views;
  for (int i = 1; i < count; ++i) views.push_back(tubetwin::ReadCloud(names[i]));
  const tubetwin::TubeScene scene =
      tubetwin::Perceive(views, tubetwin::LoadPart("pvc_a"), tubetwin::Bin(), {}, {});
  std::printf("%zu tubes\n", scene.tubes.size());
}
