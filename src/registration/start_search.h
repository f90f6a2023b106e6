/// \file start_search.h
/// Where to begin with the full clouds.
#pragma once

#include "registration/cloud_alignment.h"

namespace pcl_floam {

/// Finds a start from the guess with thinned clouds, in three ways. Near the guess alone, for clouds that share but a
/// part. Surfaces drawn to surfaces, which have to be near as well. Points drawn to points, which come from far, but
/// are drawn to where both clouds are dense, and to the sensor's pattern on the ground, so surfaces go on from there.
/// The full clouds judge between these and the guess: by what agrees, and what does not.
/// \param alignment at the guess, and then at the start
void findStart(const CloudPyramid& source, const CloudPyramid& target, const CloudRegistrationRun& run,
               CloudAlignment& alignment);

}  // namespace pcl_floam
