#pragma once

#include <weave/core/json.hpp>

namespace weave::bench {

/// 200 operators pull a released loom file of 2 MB from `loomlink serve`, 40 times a second in all, while 20
/// designers save the full-size shoe, twice a second in all; over TLS on this machine, for a minute.
/// Latencies count from the moment that was planned, so a service that falls behind does not look quick.
/// Beside it the same pull alone: the time of the transfer. Before the minute come some others, in which
/// people join at the pace that the service allows.
Json loomlink_load();

/// Bytes that the store grows by when a flip of one crossing of the full-size shoe is saved, by real
/// documents.
Json loomlink_growth();

}  // namespace weave::bench
