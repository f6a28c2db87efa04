// The commands of the program; each returns the exit status of a run without an error (terminal/exit_status.hpp).
#pragma once

#include "cli/options.hpp"

namespace dolp::cli {

/// `dolp table SCENE -o FILE`: a lookup table over the scene's grid.
int run_table(const Options& options);

/// `dolp response SCENE -o FILE`: a response table, which serves any material.
int run_response(const Options& options);

/// `dolp merge SHARD... -o FILE`: the shards of a table as one.
int run_merge(const Options& options);

/// `dolp eval SCENE --points IN -o OUT`: the same quantities at scattered points.
int run_eval(const Options& options);

/// `dolp mueller SCENE --points IN -o OUT`: the Mueller pBRDF at scattered geometries.
int run_mueller(const Options& options);

/// `dolp plan SCENE`: what a table of the scene would compute and leave out, and what it would cost.
int run_plan(const Options& options);

/// `dolp verify TABLE`: recomputes entries of a table with the independent reference; `dolp verify --hard-cases`:
/// examines a device with the model's hard cases. kExitAccuracy if a stated error is too small or a tolerance missed
/// silently.
int run_verify(const Options& options);

/// `dolp lookup TABLE --points IN -o OUT`: interpolates in a table, with the error of that.
int run_lookup(const Options& options);

/// `dolp fit SCENE --data FILE --vary KEY=LOW:HIGH`: numbers of the scene from measured data. kExitAccuracy if no
/// minimum is found.
int run_fit(const Options& options);

/// `dolp explore [SCENE]`: the window.
int run_explore(const Options& options);

/// `dolp materials`: the built-in materials, their ranges of wavelength and their sources; with `NAME --at UM` n and k.
int run_materials(const Options& options);

/// `dolp keys [KEY]`: what the keys of a scene mean and may be.
int run_keys(const Options& options);

/// `dolp devices`: the Vulkan devices, and why each one is or is not usable.
int run_devices(const Options& options);

}  // namespace dolp::cli
