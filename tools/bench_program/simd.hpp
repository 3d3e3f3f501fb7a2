#pragma once

#include <weave/command/command.hpp>

namespace weave::bench {

// Benchmarks of `simd serve`, each a command of this program: with daemons of their own, the clients beside them on the same
// machine. The answer is a table with the aims beside what was measured; with --json, all that was measured.

/// From a change, a flip or the end of a job that is asked for, to what tells of it.
void add_simd_latency(CLI::App& app, CommandOutcome& outcome);
/// The pace of sessions side by side, and beside a hostile client and one whose worker keeps dying.
void add_simd_sessions(CLI::App& app, CommandOutcome& outcome);
/// Size and error of frames.
void add_simd_frames(CLI::App& app, CommandOutcome& outcome);
/// From the death of a worker, or of the daemon, until sessions go on.
void add_simd_recovery(CLI::App& app, CommandOutcome& outcome);

}  // namespace weave::bench
