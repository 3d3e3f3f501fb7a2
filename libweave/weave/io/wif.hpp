#pragma once

#include <weave/design/design.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace weave {

/// A design read from a WIF file, and one warning for each thing in the file that was not as the format
/// demands.
struct DesignFromWif {
    Design design;
    std::vector<std::string> warnings;
};

/// Whether the text has a [WIF] section among its first 64 KiB, whatever the file is called.
bool is_wif(std::string_view text);

/// Reads WIF 1.1: drawdown from threading with tie-up and treadling, or with a lift plan; colours, thickness,
/// spacing. A design of ours comes back with its feeders, t and p, and title (our private section). Errors
/// name the line.
Result<DesignFromWif> read_wif(std::string_view text);

/// A design as WIF 1.1: shafts are the different columns of the card, THREADING and LIFTPLAN, rising shed,
/// colours, our private section with feeder order, t and p. Loose marks, rows and columns
/// without yarns, the tree of blocks and the scene are not in it: WIF has no place for them. `card` is the card image of the design's root and
/// `block` its block.
Result<std::string> write_wif(const Design& design, const Block& block, const CardImage& card);

}  // namespace weave
