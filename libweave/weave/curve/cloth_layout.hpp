#pragma once

#include <weave/curve/cloth_curves.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

namespace weave {

/// The yarns of a cloth whose key points are laid out when they are asked for, so that no memory has to hold those of a whole
/// cloth: only what concerns all of it is decided at once (which yarns there are, how picks turn, how the yarns of a line pass one
/// another), and takes a few numbers a pick and an end. Where picks would climb steeply there are the settled levels besides, four
/// bytes a crossing (settled_levels.hpp). Not for several threads at once.
class ClothLayout {
  public:
    /// As cloth_curves(), with its errors. The design and the block must outlive it.
    static Result<ClothLayout> make(const Design& design, const Block& block, const CurveOptions& options = {},
                                    std::size_t most_keys_at_once = usual_keys_at_once);
    /// Key points that are looked over at once for yarns that come too near: some 200 MB.
    static constexpr std::size_t usual_keys_at_once = 400'000;
    /// Of yarns that are not loose all along.
    struct Extent {
        std::size_t segments = 0;    ///< from key point to key point
        std::size_t open_yarns = 0;  ///< those with two ends, which have a key point more than segments
    };
    /// What they will be before turns are cleared of other yarns, which may add some: two seconds for a shoe of 7 million, where make()
    /// takes twenty. Errors as make().
    static Result<Extent> foreseen(const Design& design, const Block& block, const CurveOptions& options = {});
    ClothLayout(ClothLayout&&) noexcept;
    ClothLayout& operator=(ClothLayout&&) noexcept;
    ~ClothLayout();

    /// The curves without key points and crossings.
    [[nodiscard]] const ClothCurves& bare() const;
    /// How many key points a yarn of bare() has.
    [[nodiscard]] std::size_t keys(std::size_t yarn) const;
    /// Appends the key points of a yarn from `first` to before `last`.
    void add_keys(std::size_t yarn, std::size_t first, std::size_t last, std::vector<KeyPoint>& to) const;
    /// Visits the crossings of a weft along it.
    void each_crossing(std::size_t weft, const std::function<void(const Crossing&)>& visit) const;

  private:
    class Lines;
    explicit ClothLayout(std::unique_ptr<Lines> lines);
    std::unique_ptr<Lines> m_lines;
};

/// All of a cloth at once.
ClothCurves all_curves(const ClothLayout& layout);

}  // namespace weave
