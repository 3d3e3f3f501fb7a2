#pragma once

#include <weave/sim/yarns.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace weave {

/// A pick or an end, counted from 0 in the whole cloth as everywhere in the library; words and JSON count
/// from 1.
struct YarnNumber {
    System system = System::warp;
    std::size_t number = 0;
    friend bool operator==(const YarnNumber&, const YarnNumber&) = default;
};

/// Least, mean and greatest of a share or a length, and whose they are.
struct Spread {
    double least = 0, mean = 0, most = 0;
    std::size_t least_of = 0, most_of = 0;  ///< picks or ends
};

/// How much longer an end is than the cloth that it lies in.
struct EndTakeUp {
    std::size_t end = 0;
    std::uint32_t beam = 0;
    double take_up = 0;  ///< (yarn length - cloth length) / cloth length
};

/// Take-up of the ends of one beam.
struct BeamTakeUp {
    std::uint32_t beam = 0;
    std::size_t ends = 0;
    Spread spread;
    /// Greatest difference between two ends of the beam with equal yarn that pass the picks in the same
    /// order, each from its own first pick: they should take up alike. Nothing where no two ends are so.
    std::optional<double> alike;
    std::size_t alike_least_of = 0, alike_most_of = 0;  ///< ends
};

/// A yarn further from its place than it is wide. The place is the planned one after its sheet has settled:
/// what a whole sheet slides, shears or is pressed flat by is no fault of one yarn and is taken off.
struct MovedYarn {
    YarnNumber yarn;
    double mm = 0, widths = 0;  ///< at its worst crossing
    Vec3 way{0, 0, 0};          ///< there, mm: x towards later picks, y to the right, z up; 0 along the yarn
    double mean_mm =
        0;  ///< across the yarn and in the cloth's plane: mean over its crossings, signed as `way`
    std::size_t crossed = 0;  ///< pick or end that it crosses there
};

/// Yarns that lie at the same place in each row (picks) or column (ends) and lean together: on the mean over
/// all rows they stand further off the straight line between those below and above them than a yarn is wide,
/// and than two fifths of the way to the next row.
struct LeaningLayer {
    System system = System::weft;
    std::size_t layer = 0, of = 0;  ///< counted from the bottom, from 0, and how many there are
    double mm = 0, widths = 0;      ///< positive: towards later picks, or to the right
    double same_way = 0;            ///< share of the rows that lean this way
    std::vector<std::size_t> numbers;
};

/// Neighbours of one layer that have come nearer to one another than planned by more than half a yarn's
/// width.
struct BunchedPair {
    YarnNumber first, second;
    double planned_mm = 0, mm = 0;  ///< from centre to centre
    bool touching = false;
    bool next_repeat = false;  ///< `second` is that of the following repeat
};

/// Where a yarn has no room left: between two neighbours it passes from one face to the other without a
/// straight piece (Peirce's jam), however much harder the cloth is beaten.
struct JammedYarn {
    YarnNumber yarn;
    std::size_t places = 0, of = 0;        ///< jammed changes of side, of all of this yarn
    std::array<std::size_t, 2> between{};  ///< picks or ends where it is tightest
    double room = 0;                       ///< their distance over the least that Peirce allows, less 1
};

/// A crossing that does not lie as it was planned.
struct ChangedCrossing {
    std::size_t pick = 0, end = 0;
    bool weft_over = false;  ///< as the card says
    bool found = true;       ///< whether the yarns still cross near there
};

/// First and last of a row of numbers, from 0.
using NumberSpan = std::array<std::size_t, 2>;

/// Which part of its cloth a piece is.
struct InspectedPart {
    bool is_whole = true;
    NumberSpan rows{}, columns{};
    std::optional<NumberSpan> picks, ends;  ///< that cross in it; nothing where none do
    std::size_t cloth_rows = 0, cloth_columns = 0;
    std::optional<std::size_t> cloth_picks, cloth_ends;  ///< where the report of the run tells them
};

/// So many rows or columns from a frozen rim nothing is measured: it is held as planned, so yarns near it run
/// steeper, and jam where they would have room. How far that reaches was measured (README.md): crimp is that
/// of the cloth from the second row or the third column on.
inline constexpr std::size_t disturbed_by_rim = 2;
/// A yarn that is left over fewer rows or columns than this says nothing of its crimp.
inline constexpr std::size_t least_measured = 4;

/// What a weaver wants to know of a relaxed cloth. Where its rims were frozen all that is measured, and all
/// that moved, leans, bunches or jams, is of what lies further inside than `disturbed_by_rim`.
struct Inspection {
    InspectedPart part;
    std::array<bool, 2> frozen_rims{};                  ///< across x and y
    std::size_t measured_picks = 0, measured_ends = 0;  ///< all, where no rim is frozen
    std::vector<EndTakeUp> take_up;                     ///< by end, of those that can be measured
    std::vector<BeamTakeUp> beams;
    std::optional<Spread> warp_crimp, weft_crimp;  ///< (length - straight length) / straight length
    /// From the lowest to the highest surface of a yarn; nothing where nothing can be measured.
    std::optional<double> thickness_mm;
    double settled = 1;  ///< height of the thickest sheet over the planned one, from centre to centre
    std::vector<std::vector<YarnNumber>>
        sheets;  ///< that nothing binds to one another, lowest first; see sheets_of
    std::vector<LeaningLayer> leaning;
    std::vector<BunchedPair> bunched;  ///< nearest first
    std::vector<MovedYarn> moved;      ///< furthest first
    std::vector<JammedYarn> jammed;    ///< tightest first
    std::vector<ChangedCrossing> changed;  ///< no longer as the card says: a yarn passed through another
    std::vector<ChangedCrossing> slid;     ///< gone from their place, though no yarn passed through another (order.hpp)
    std::size_t picks = 0, ends = 0;  ///< that are in this piece
};

/// Looks a relaxed cloth over. Errors: a report that does not tell `points_per_key`, crossings beyond their
/// yarns.
Result<Inspection> inspect(const Yarns& yarns);

/// The inspection with what the yarns' report tells of the run, as `weave inspect --json` prints it.
Json inspection_json(const Yarns& yarns, const Inspection& inspection);

/// The same in words, a short page: the worst of each kind, and how many there are.
std::string inspection_text(const Yarns& yarns, const Inspection& inspection);

}  // namespace weave
