#pragma once

#include <weave/core/result.hpp>
#include <weave/design/design.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace weave::studio {

/// The folder of one open document: its design as it was opened or saved last, and the journal of what was done since. While a
/// program has it, it is locked; the lock ends with the program, however that ends.
class JournalFolder {
  public:
    /// A new one within `parent`. Errors: the disk.
    static Result<JournalFolder> make(const std::filesystem::path& parent);
    /// One that is there; nothing where another program has it.
    static std::optional<JournalFolder> take(const std::filesystem::path& folder);

    JournalFolder(JournalFolder&& other) noexcept;
    JournalFolder& operator=(JournalFolder&& other) noexcept;
    ~JournalFolder();

    /// Puts a new base and the lines behind it in the place of what was there. After an error that is as it was, and goes on.
    /// `path`: of the design's file, or empty.
    Status begin(const Design& design, const std::string& path, bool is_saved, std::string_view lines = {});
    /// Goes on behind so many bytes of the journal that is there; what lies beyond is torn and goes.
    Status resume(std::uint64_t bytes);
    /// Adds a line of the journal, whole or not at all.
    Status add(std::string_view line);
    /// Brings what was added onto the disk.
    Status sync();
    /// Removes it with all that is in it.
    void remove();

    [[nodiscard]] const std::filesystem::path& path() const { return m_path; }

    /// What is in it, as begin() and add() put it there.
    struct Content {
        Design base;
        std::string path, journal;
        bool base_was_saved = true;
    };
    [[nodiscard]] Result<Content> read() const;

  private:
    JournalFolder(std::filesystem::path path, int lock) : m_path(std::move(path)), m_lock(lock) {}
    [[nodiscard]] std::filesystem::path file(const std::string& base, const char* kind) const { return m_path / (base + kind); }
    [[nodiscard]] Result<int> opened_journal(const std::string& base) const;
    void use_journal(std::string base, int journal, std::uint64_t bytes);
    Status cut_torn_line();
    void close_files();

    std::filesystem::path m_path;
    int m_lock = -1, m_journal = -1;
    std::string m_base;          ///< name of the base that `now` names, and of its journal
    std::uint64_t m_bytes = 0;   ///< of the journal's whole lines
    bool m_may_be_torn = false;  ///< something may lie behind them
};

}  // namespace weave::studio
