#pragma once

#include <weave/design/yarns.hpp>
#include <weave/io/wif_drawdown.hpp>

namespace weave::wif {

/// The yarns of both systems as the sections for colours, thickness and spacing tell them.
struct Plans {
    WarpPlan warp = default_warp();
    WeftPlan weft = default_weft();
};

/// A yarn type for each thickness of the warp, a feeder for each weft yarn (colour and thickness), ends that
/// differ in colour through colour_order, mean spacing as density. What a file does not tell, or tells
/// without its unit, stays as in the default plans. At most 64 feeders: further weft yarns come from the
/// feeder whose colour is nearest, with a warning.
Result<Plans> read_plans(const File& file, const Threads& ends, const Threads& picks, Warnings& warnings);

}  // namespace weave::wif
