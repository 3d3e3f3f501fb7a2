#pragma once

#include <weave/block/slice.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace weave {

/// One yarn of a slice: a dot by its position and its number there, a path by its number alone. From 0.
struct SliceYarnId {
    bool path = false;
    std::size_t position = 0;  ///< of a dot; 0 for a path
    std::size_t number = 0;
    static SliceYarnId dot(std::size_t position, std::size_t number) { return {false, position, number}; }
    static SliceYarnId run(std::size_t number) { return {true, 0, number}; }
    friend bool operator==(const SliceYarnId&, const SliceYarnId&) = default;
    friend auto operator<=>(const SliceYarnId&, const SliceYarnId&) = default;
};

/// Whether a place holds a yarn that is seen end-on, or one that runs along the slice.
inline bool is_dot(const Slice& slice, const SliceYarn& place) {
    return slice.dots == System::weft ? place.yarn.is_weft() : place.yarn.is_warp();
}
inline bool is_path(const Slice& slice, const SliceYarn& place) {
    return slice.dots == System::weft ? place.yarn.is_warp() : place.yarn.is_weft();
}

/// Dots that a position draws, disabled ones included; paths of the slice, as its first position has them.
std::size_t dots_at(const Slice& slice, std::size_t position);
std::size_t paths_of(const Slice& slice);
/// Places of the highest position.
std::size_t levels_of(const Slice& slice);

/// Whether the slice draws this yarn.
bool holds(const Slice& slice, const SliceYarnId& yarn);
/// The level at which a yarn lies, from 0; a path is looked for in `position`, a dot in its own. Nothing
/// where it is not there.
std::optional<std::size_t> level_of(const Slice& slice, const SliceYarnId& yarn, std::size_t position);
/// How many dots of the position lie below the path there, disabled ones included. The path must be there.
std::size_t gap_of(const Slice& slice, std::size_t path, std::size_t position);
/// Whether the yarn is a weft that is drawn but not woven.
bool is_disabled(const Slice& slice, const SliceYarnId& yarn);

/// What each yarn is on the card, from 0: picks and ends are counted as to_block() counts them. Disabled
/// wefts have no number.
struct SliceNumbers {
    std::vector<std::vector<std::optional<std::size_t>>> dots;  ///< by position and number
    std::vector<std::optional<std::size_t>> paths;
    [[nodiscard]] std::optional<std::size_t> of(const SliceYarnId& yarn) const {
        return yarn.path ? paths.at(yarn.number) : dots.at(yarn.position).at(yarn.number);
    }
};
SliceNumbers card_numbers(const Slice& slice);

/// `weft 2 of position 3` for a dot, `warp 1` for a path; counted from 1.
std::string in_words(const Slice& slice, const SliceYarnId& yarn);

}  // namespace weave
