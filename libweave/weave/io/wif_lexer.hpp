#pragma once

#include <weave/core/result.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// The parts of a WIF file: what reader and writer share, no interface of the library.
namespace weave::wif {

/// A file with more lines, counting neither blank ones nor comments, is refused; so is one with more threads,
/// shafts, treadles or sections.
inline constexpr std::size_t most_lines = std::size_t{1} << 23;
inline constexpr std::size_t most_threads = std::size_t{1} << 22;
inline constexpr std::uint32_t most_shafts = std::uint32_t{1} << 20;
inline constexpr std::size_t most_sections = 4096;

/// The section that is ours.
inline constexpr std::string_view private_name = "private weave design";

/// One `key=value`, both trimmed, as views into the text of the file.
struct Entry {
    std::string_view key, value;
    std::uint32_t line = 0;  ///< from 1
    bool assigns = true;     ///< whether there is a `=`; without one the whole line is the key
};

struct Section {
    std::string name;  ///< lower case, single spaces
    std::size_t line = 0;
    std::size_t offset = 0;  ///< where the header starts in the text
    std::vector<Entry> entries;
    std::vector<std::size_t> repeated;  ///< lines of further headers of the same name, whose entries follow

    /// The entry of this name (lower case), or nothing. The first one where there are several.
    [[nodiscard]] const Entry* find(std::string_view key) const;
};

struct File {
    std::vector<Section> sections;  ///< in the order in which they first come
    std::map<std::string, std::size_t, std::less<>> index;
    [[nodiscard]] const Section* find(std::string_view name) const;
};

/// Splits the text at its sections. Line ends may be CRLF, LF or CR. Errors: text before the first section, a
/// header without `]`, UTF-16, too much of anything.
Result<File> split(std::string_view text);

/// What was odd about a file, a bounded number of times.
class Warnings {
  public:
    void add(std::size_t line, const std::string& message);
    void add(const std::string& message);
    [[nodiscard]] std::vector<std::string> take() &&;

  private:
    std::vector<std::string> m_texts;
    std::size_t m_left_out = 0;
};

std::string place(std::size_t line);
/// Lower case, trimmed, inner blanks as one space.
std::string normal(std::string_view name);
/// `[name]` for a message, in capitals.
std::string shown(std::string_view section);
/// At most 40 bytes of a file's own words, in quotes and fit for a message.
std::string in_quotes(std::string_view words);

/// A value that is no free text: without the comment that may follow it.
std::string_view plain(std::string_view value);
/// Free text as UTF-8: bytes that are not are taken for latin-1.
std::string utf8(std::string_view value);

Result<bool> boolean(const Entry& entry);
/// A whole number from `low` to `high`; a zero fraction (`12.0`) is tolerated.
Result<std::int64_t> whole(const Entry& entry, std::int64_t low, std::int64_t high);
/// A finite decimal number.
Result<double> decimal(const Entry& entry);
/// Whole numbers from 0 to `high` with commas between them; empty places are skipped.
Result<std::vector<std::uint32_t>> whole_list(std::string_view value, std::size_t line, std::uint32_t high);

/// The lines of a section whose keys are numbers, sorted by number; a number that is given twice with the
/// same value comes once. Errors: a key that is no number, two values for one number.
Result<std::vector<std::pair<std::size_t, Entry>>> numbered(const Section& section, Warnings& warnings);

}  // namespace weave::wif
