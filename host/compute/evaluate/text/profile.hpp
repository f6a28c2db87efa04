// Where masking does not depend on the slope distribution, the sums over the azimuths at a slope serve every
// distribution: the profile of a direction and an index is these sums along the slope axis, and the moments of each
// distribution are its integral with the distribution's own weights.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "evaluate/text/text.hpp"
#include "model/moments.hpp"
#include "plan/kernel_data.hpp"

namespace dolp {

/// True if the moments of a request are integrals of profiles.
bool has_profiles(const MomentsRequest& request);

/// A direction of a request and an index, with the shapes of which moments are wanted: positions in KernelData.
struct ProfileEntries {
  std::uint32_t direction = 0;
  std::uint32_t theta = 0;
  std::uint32_t index = 0;
  std::vector<std::uint32_t> shapes;
};

/// One slope of a rule, and its weight dt.
struct ProfileSlope {
  double t = 0.0;
  double dt = 0.0;
  double digits = 0.0;  ///< wanted of the sum over the azimuths
};

/// The two rules of a piece of the slope axis: slopes first ... first + fine - 1, then those of the coarser one.
struct ProfilePiece {
  double start = 0.0;
  double end = 0.0;
  std::uint32_t first = 0;
  std::uint32_t fine = 0;
  std::uint32_t coarse = 0;
  std::uint32_t of_direction = 0;  ///< the piece of KernelData::pieces that it is in
};

/// Where a profile is sampled: slopes that serve all its shapes. They follow from its entries alone.
struct Profile {
  ProfileEntries entries;
  double cut = 0.0;  ///< slopes beyond it are left out
  std::vector<ProfilePiece> pieces;
  std::vector<ProfileSlope> slopes;
};

/// Plans profiles of a request and integrates them. `data` must outlive it; any thread may call it.
class Profiles {
 public:
  explicit Profiles(const KernelData& data);
  ~Profiles();

  Profile plan(ProfileEntries entries) const;
  /// Appends the kernel's input, slope by slope.
  void append(const Profile& profile, std::vector<kernel::SlopeNode>& nodes) const;
  /// Puts the moments of the profile's shapes at the places of their entries in the request; `samples` holds the
  /// kernel's result for each of its slopes, `unit_roundoff` is that of its precision.
  void integrate(const Profile& profile, std::span<const kernel::AzimuthNode> samples, double unit_roundoff,
                 std::span<Moments> moments) const;
  /// Plans, samples and integrates profiles with the kernel source compiled for the CPU.
  void compute(ProfileEntries entries, KernelText& text, double unit_roundoff, std::span<Moments> moments) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The wanted entries of the directions `first` to `last` - 1 of a request.
std::vector<ProfileEntries> profile_entries(const MomentsRequest& request, const KernelData& data, std::size_t first,
                                            std::size_t last);

}  // namespace dolp
