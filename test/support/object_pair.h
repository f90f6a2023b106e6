/// \file object_pair.h
/// Two samplings of an object to register, and a rejector that tells what it saw.
#pragma once

#include "support/registration_clouds.h"

#include <pcl_floam/registration/edge_plane_registration.h>

#include <pcl/common/transforms.h>

#include <vector>

namespace pcl_floam::test {

/// A registration of two samplings of the object that are apart by motion(1.0).
struct ObjectPair {
  ObjectPair() : source(pcl::make_shared<Cloud>()), target(sampledObject(1, 1.0))
  {
    pcl::transformPointCloud(*sampledObject(2, 1.0), *source, Eigen::Matrix4f(motion(1.0).inverse()));
    registration.setInputSource(source);
    registration.setInputTarget(target);
  }

  double align()
  {
    registration.align(output);
    return disagreement(*source, registration.getFinalTransformation(), motion(1.0));
  }

  Cloud::Ptr source;
  Cloud::Ptr target;
  EdgePlaneRegistration<Point, Point> registration;
  Cloud output;
};

/// Keeps every second correspondence and remembers what it saw.
class Halving : public pcl::registration::CorrespondenceRejector {
public:
  void getRemainingCorrespondences(const pcl::Correspondences& original, pcl::Correspondences& remaining) override
  {
    seen.push_back(original);
    remaining.clear();
    for (std::size_t i = 0; i < original.size(); i += 2) {
      remaining.push_back(original[i]);
    }
  }
  void applyRejection(pcl::Correspondences& correspondences) override
  {
    getRemainingCorrespondences(*input_correspondences_, correspondences);
  }

  std::vector<pcl::Correspondences> seen;
};

}  // namespace pcl_floam::test
