#pragma once

#include <weave/block/slice_numbers.hpp>
#include <weave/design/design.hpp>
#include <weave/picture/slice_map.hpp>

#include <QColor>
#include <QString>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace weave::studio {

/// A yarn that is seen end-on, as it is shown.
struct SceneDot {
    SliceYarnId yarn;  ///< position counts from the first of the whole slice
    std::size_t level = 0;
    std::optional<std::size_t> number;  ///< on the card, from 0; none where it is not woven
    QColor colour;
    bool loose = false;
};

/// A yarn that runs along the slice, as it is shown.
struct ScenePath {
    SliceYarnId yarn;
    std::optional<std::size_t> number;
    QColor colour;
    std::size_t first = 0;            ///< position of the first level
    std::vector<std::size_t> levels;  ///< one for each position
    std::vector<bool> loose;
    double shift = 0;  ///< how yarns that swap levels step aside, -0.5 … 0.5
    bool leftwards = false;
    bool reaches_left = true, reaches_right = true;  ///< runs on to the edge, rather than to a turn
    std::size_t woven_first = 0, woven_last = 0;     ///< positions between which the yarn lies in the cloth
    std::vector<std::size_t> arrows;  ///< positions behind which an arrow shows the shuttle's way
    [[nodiscard]] std::size_t last() const { return first + levels.size() - 1; }
    [[nodiscard]] std::optional<std::size_t> level_at(std::size_t position) const {
        if (position < first || position > last()) return {};
        return levels[position - first];
    }
};

/// Where a weft turns at the side of the cloth: from one shown path to another, or out of the slice.
struct SceneTurn {
    bool right = false, caught = true;
    std::optional<std::size_t> from, to;  ///< paths of the scene
    std::size_t other_pick = 0;  ///< where it goes to, or comes from, when it leaves the slice; from 0
};

/// A slice, or the part of it that is laid out.
struct SliceScene {
    System dots = System::weft;
    std::size_t begin = 0, positions = 0;  ///< the part laid out
    std::size_t all_positions = 0, levels = 0;
    std::vector<SceneDot> dot_list;
    std::vector<ScenePath> paths;
    std::vector<SceneTurn> turns;
    [[nodiscard]] bool wefts_run() const { return dots == System::warp; }
};

/// A drawn slice as a scene, all of it. `design` gives the colours, the feeders and whether the weft wraps
/// round. A slice that is no cloth has no yarns.
SliceScene scene_of(const Slice& slice, const Design& design);

/// Looks at the rows and columns of one block, part by part. What all parts need is found out once, which
/// takes long for a large cloth: any thread may do that.
class BlockSlices {
  public:
    BlockSlices(const Design& design, BlockPtr block);
    [[nodiscard]] const Block& block() const { return *m_block; }
    [[nodiscard]] const Design& design() const { return m_design; }
    /// Positions of the slices whose dots are of this system, and how many such slices there are.
    [[nodiscard]] std::size_t positions(System dots) const;
    [[nodiscard]] std::size_t lines(System dots) const;
    /// Positions from `begin` on; the yarns' numbers are those of the card, and in their ids those within the
    /// cell.
    [[nodiscard]] SliceScene part(System dots, std::size_t line, std::size_t begin, std::size_t count) const;

  private:
    Design m_design;
    BlockPtr m_block;
    Subject m_subject;
    YarnColours m_colours;
    WeftRuns m_runs;
};

/// A colour of the library as Qt has it.
QColor to_qt(Colour colour);

}  // namespace weave::studio
