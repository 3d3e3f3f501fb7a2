#include <studio/document/journal_folder.hpp>

#include <weave/core/file.hpp>
#include <weave/design/document.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <studio/document/journal_now.hpp>
#include <utility>

namespace weave::studio {

namespace {

constexpr std::uint64_t most_journal_bytes = std::uint64_t{4} << 30;

Error disk_error(const std::string& what, const std::filesystem::path& path) {
    return system_fault(what + ": " + std::strerror(errno), path.string());
}

/// A locked descriptor of the folder's lock; -1 where another program has it.
int locked(const std::filesystem::path& folder, int flags) {
    const int lock = open((folder / "lock").c_str(), flags | O_RDWR | O_CLOEXEC, 0600);
    if (lock >= 0 && flock(lock, LOCK_EX | LOCK_NB) == 0) return lock;
    if (lock >= 0) close(lock);
    return -1;
}

Result<JournalNow> now_of(const std::filesystem::path& folder) {
    constexpr std::uint64_t most_bytes = 1 << 20;
    WEAVE_TRY(const std::string text, read_file(folder / "now", most_bytes));
    auto now = read_journal_now(text);
    if (!now) return std::move(now).error().in((folder / "now").string());
    return now;
}

}  // namespace

Result<JournalFolder> JournalFolder::make(const std::filesystem::path& parent) {
    std::error_code trouble;
    std::filesystem::create_directories(parent, trouble);
    std::string name = (parent / "open-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) return disk_error("no folder for unsaved work can be made", parent);
    const int lock = locked(name, O_CREAT);
    if (lock < 0) return disk_error("the folder for unsaved work cannot be locked", name);
    return JournalFolder(name, lock);
}

std::optional<JournalFolder> JournalFolder::take(const std::filesystem::path& folder) {
    const int lock = locked(folder, 0);
    if (lock < 0) return std::nullopt;
    return JournalFolder(folder, lock);
}

JournalFolder::JournalFolder(JournalFolder&& other) noexcept
    : m_path(std::move(other.m_path)), m_lock(std::exchange(other.m_lock, -1)), m_journal(std::exchange(other.m_journal, -1)),
      m_base(std::move(other.m_base)), m_bytes(other.m_bytes), m_may_be_torn(other.m_may_be_torn) {}

JournalFolder& JournalFolder::operator=(JournalFolder&& other) noexcept {
    std::swap(m_path, other.m_path);
    std::swap(m_lock, other.m_lock);
    std::swap(m_journal, other.m_journal);
    std::swap(m_base, other.m_base);
    std::swap(m_bytes, other.m_bytes);
    std::swap(m_may_be_torn, other.m_may_be_torn);
    return *this;
}

JournalFolder::~JournalFolder() {
    close_files();
}

void JournalFolder::close_files() {
    if (m_journal >= 0) close(std::exchange(m_journal, -1));
    if (m_lock >= 0) close(std::exchange(m_lock, -1));
}

Status JournalFolder::begin(const Design& design, const std::string& path, bool is_saved, std::string_view lines) {
    // A base and the journal behind it are named together, and `now` names the pair: whenever the program ends, one whole pair
    // is there. Until `now` names the new one, nothing of the old one is touched.
    const std::string next = m_base == "a" ? "b" : "a", old = m_base;
    WEAVE_CHECK_OK(write_file(file(next, ".weave"), write_document(design)));
    WEAVE_CHECK_OK(write_file(file(next, ".journal"), lines));
    WEAVE_TRY(const int journal, opened_journal(next));
    if (Status named = write_file(m_path / "now", journal_now_text({next, path, is_saved})); !named) {
        close(journal);
        return named;
    }
    use_journal(next, journal, lines.size());
    if (old.empty()) return {};
    std::error_code ignored;
    std::filesystem::remove(file(old, ".weave"), ignored);
    std::filesystem::remove(file(old, ".journal"), ignored);
    return {};
}

Result<int> JournalFolder::opened_journal(const std::string& base) const {
    const int journal = open(file(base, ".journal").c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
    if (journal < 0) return disk_error("the journal of unsaved work cannot be opened", m_path);
    return journal;
}

void JournalFolder::use_journal(std::string base, int journal, std::uint64_t bytes) {
    if (m_journal >= 0) close(m_journal);
    m_journal = journal;
    m_base = std::move(base);
    m_bytes = bytes;
    m_may_be_torn = false;
}

Status JournalFolder::resume(std::uint64_t bytes) {
    WEAVE_TRY(const JournalNow now, now_of(m_path));
    WEAVE_TRY(const int journal, opened_journal(now.base));
    use_journal(now.base, journal, bytes);
    m_may_be_torn = true;
    return cut_torn_line();
}

Status JournalFolder::add(std::string_view line) {
    WEAVE_CHECK_OK(cut_torn_line());
    m_may_be_torn = true;
    for (std::string_view left = line; !left.empty();) {
        const ssize_t written = write(m_journal, left.data(), left.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) {
            const Error full = disk_error("unsaved work cannot be kept on the disk", m_path);
            static_cast<void>(cut_torn_line());  // else it is tried again before the next line
            return full;
        }
        left.remove_prefix(static_cast<std::size_t>(written));
    }
    m_may_be_torn = false;
    m_bytes += line.size();
    return {};
}

/// A line behind a torn one would not be read.
Status JournalFolder::cut_torn_line() {
    if (!m_may_be_torn) return {};
    if (ftruncate(m_journal, static_cast<off_t>(m_bytes)) != 0) return disk_error("the journal of unsaved work cannot be mended", m_path);
    m_may_be_torn = false;
    return {};
}

Status JournalFolder::sync() {
    if (m_journal >= 0 && fdatasync(m_journal) != 0) return disk_error("unsaved work cannot be kept on the disk", m_path);
    return {};
}

void JournalFolder::remove() {
    std::error_code ignored;
    std::filesystem::remove_all(m_path, ignored);
    close_files();
}

Result<JournalFolder::Content> JournalFolder::read() const {
    WEAVE_TRY(const JournalNow now, now_of(m_path));
    Content content;
    WEAVE_TRY(content.base, load_design(file(now.base, ".weave")));
    WEAVE_TRY(content.journal, read_file(file(now.base, ".journal"), most_journal_bytes));
    content.path = now.path;
    content.base_was_saved = now.is_saved;
    return content;
}

}  // namespace weave::studio
