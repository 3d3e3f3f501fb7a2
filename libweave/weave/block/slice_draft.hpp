#pragma once

#include <weave/block/slice_numbers.hpp>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace weave {

/// A slice that is being changed: all its positions have the same number of levels, so that a level which one
/// position needs is put in everywhere and dots that lie side by side stay so.
class SliceDraft {
  public:
    /// Errors: a slice that is no cloth (to_block).
    static Result<SliceDraft> open(const Slice& slice);

    [[nodiscard]] const Slice& slice() const { return m_slice; }
    [[nodiscard]] std::size_t levels() const { return m_was_empty.size(); }
    [[nodiscard]] std::vector<SliceYarn>& at(std::size_t position) { return m_slice.positions[position]; }
    [[nodiscard]] std::vector<std::vector<SliceYarn>>& positions() { return m_slice.positions; }
    [[nodiscard]] bool is_empty(std::size_t position, std::size_t level) const {
        return level < levels() && m_slice.positions[position][level].yarn.is_empty();
    }

    /// A level of empty places below level `level` (levels() puts it on top).
    void insert_level(std::size_t level);
    void erase_level(std::size_t level);
    /// Takes the yarn from its place, which stays empty.
    SliceYarn lift(std::size_t position, std::size_t level);
    /// Puts a yarn that runs along the slice above exactly `gap` dots of a position: into the empty place
    /// there that is nearest to `wish`, or into a level of its own.
    void lay(std::size_t position, std::size_t gap, std::size_t wish, const SliceYarn& yarn);

    /// Changes the numbers of the yarns that one position draws as dots, or of all paths.
    void renumber_dots(std::size_t position, const std::function<std::size_t(std::size_t)>& number);
    void renumber_paths(const std::function<std::size_t(std::size_t)>& number);

    /// The slice without the levels that the change has emptied; `subject` is what an error says of it.
    Result<Slice> finish(const std::string& subject) &&;
    /// The slice with all its levels.
    Result<Slice> finish_levels(const std::string& subject) &&;

  private:
    explicit SliceDraft(Slice slice);
    Slice m_slice;
    std::vector<bool>
        m_was_empty;  ///< for each level, whether no position had a yarn there before the change
};

}  // namespace weave
