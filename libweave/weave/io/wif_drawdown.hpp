#pragma once

#include <weave/block/card_image.hpp>
#include <weave/io/wif_lexer.hpp>

namespace weave::wif {

/// The threads of one system, as a file lists them.
struct Threads {
    std::size_t count = 0;
    bool from_zero = false;  ///< the file counts them from 0, not from 1
    std::size_t listed = 0;  ///< a warning has told of those from here on, which no section lists
};

/// Which sections say how the picks are woven: TIEUP and TREADLING, or LIFTPLAN.
enum class Drive { treadles, lift_plan };

/// An error where the file holds neither. Where it holds both, treadles win, with a warning.
Result<Drive> drive_of(const File& file, Warnings& warnings);

/// How many ends, and picks, there are: as many as the file lists, or as [WARP] or [WEFT] say where at most a
/// quarter of those is not listed (unlisted threads lift nothing). A warning, with the rule, where both
/// differ.
Result<Threads> ends_of(const File& file, Warnings& warnings);
Result<Threads> picks_of(const File& file, Drive drive, Warnings& warnings);

/// The lines of a section that says something of each thread, numbers made to count from 0. Errors: a thread
/// beyond the count.
Result<std::vector<std::pair<std::size_t, Entry>>> per_thread(const Section& section, const Threads& threads,
                                                              Warnings& warnings);

/// The card image: pick by pick the shafts that rise (or sink), and the ends on them. Warnings name what
/// lifts nothing, as that is seldom meant: ends that [THREADING] leaves out or puts on shaft 0, picks without a line,
/// and treadles that picks press but [TIEUP] leaves out. A pick or treadle of shaft 0 says so itself.
Result<CardImage> drawdown(const File& file, Drive drive, const Threads& ends, const Threads& picks,
                           Warnings& warnings);

}  // namespace weave::wif
