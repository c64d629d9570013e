#pragma once

#include "models/base/cloud/cloud.h"
#include "models/bin.h"
#include "models/part.h"
#include "perception/scene/tube_scene.h"

namespace tubetwin {

/// The modelling of Leão et al. 2020 as somebody who knows PCL writes it down, step by step, with
/// the library's own classes and its OpenMP where it has that: 100,000 random points, normals by
/// radius search among the whole unfiltered cloud through a kd-tree (as the paper says), region
/// growing, RANSAC cylinders, greedy joining. One organised view, X_NS in the cloud. What others
/// are compared with (`keep_short`: nothing is discarded for its length); not used by the program.
TubeScene PlainPcl(const OrganizedCloud& cloud, const Part& part, const Bin& bin, int threads,
                   bool keep_short);

}  // namespace tubetwin
