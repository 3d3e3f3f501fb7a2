#pragma once

#include <weave/core/result.hpp>
#include <weave/design/design.hpp>

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <studio/document/journal.hpp>
#include <studio/document/journal_folder.hpp>
#include <utility>

namespace weave::studio {

/// Writes the journal of one document. What cannot be written waits, in its order, and is tried again with all that comes later:
/// the disk may be behind, but it never skips anything.
class JournalWriter {
  public:
    /// In a new folder within `recoveries`, once there is something to write.
    explicit JournalWriter(std::filesystem::path recoveries) : m_recoveries(std::move(recoveries)) {}

    Status begin(const Design& design, const std::string& path, bool is_saved);
    /// Goes on in a journal that is there, behind so many bytes.
    Status resume(std::shared_ptr<JournalFolder> folder, std::uint64_t bytes);
    Status add(const JournalEntry& entry);
    /// The design as it stands is being saved, and this is what is shown of it. Saves end in the order in which they begin.
    void begin_save(const JournalEntry& shown);
    /// This design was saved: the journal begins anew behind it, with what was added meanwhile.
    Status end_save(const Design& design, const std::string& path);
    void fail_save();
    /// Removes it; nothing more is written.
    void remove();

    /// Writes what waits.
    Status catch_up();
    /// Brings what was written onto the disk.
    Status sync();
    [[nodiscard]] bool is_behind() const { return m_base || !m_lines.empty(); }
    [[nodiscard]] bool has_work() const { return is_behind() || m_is_dirty; }

  private:
    Status begin_behind(std::function<Status()> base);

    std::filesystem::path m_recoveries;
    std::shared_ptr<JournalFolder> m_folder;
    std::function<Status()> m_base;      ///< writes the base on which the lines stand; none: it is written
    std::deque<std::string> m_lines;     ///< that are not written
    std::deque<std::string> m_in_saves;  ///< of each save that is under way, the lines since it began
    bool m_is_dirty = false, m_is_removed = false;
};

}  // namespace weave::studio
