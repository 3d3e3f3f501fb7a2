#include <studio/document/journal_folder.hpp>

#include <weave/core/file.hpp>
#include <weave/core/json.hpp>
#include <weave/design/document.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
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

/// What the file `now` tells: which base and journal count.
struct Now {
    std::string base, path;
    bool is_saved = true;
};

Result<Now> read_now(const std::filesystem::path& folder) {
    WEAVE_TRY(const std::string text, read_file(folder / "now"));
    WEAVE_TRY(const Json now, parse_json(text));
    const auto is_named = [&](const char* name) { return now.is_object() && now.contains(name) && now[name].is_string(); };
    if (!is_named("base") || !is_named("path") || !now.contains("is_saved") || !now["is_saved"].is_boolean())
        return bad_input("does not tell what lies here", (folder / "now").string());
    Now read{now["base"], now["path"], now["is_saved"]};
    if (read.base != "a" && read.base != "b") return bad_input("names a base that there cannot be", (folder / "now").string());
    return read;
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
      m_base(std::move(other.m_base)) {}

JournalFolder& JournalFolder::operator=(JournalFolder&& other) noexcept {
    close_files();
    m_path = std::move(other.m_path);
    m_lock = std::exchange(other.m_lock, -1);
    m_journal = std::exchange(other.m_journal, -1);
    m_base = std::move(other.m_base);
    return *this;
}

JournalFolder::~JournalFolder() {
    close_files();
}

void JournalFolder::close_files() {
    if (m_journal >= 0) close(std::exchange(m_journal, -1));
    if (m_lock >= 0) close(std::exchange(m_lock, -1));
}

Status JournalFolder::begin(const Design& design, const std::string& path, bool is_saved) {
    // A base and the journal behind it are named together, and `now` names the pair: whenever the program ends, one whole pair
    // is there.
    const std::string old = m_base;
    m_base = old == "a" ? "b" : "a";
    WEAVE_CHECK_OK(write_file(m_path / (m_base + ".weave"), write_document(design)));
    WEAVE_CHECK_OK(write_file(m_path / (m_base + ".journal"), ""));
    const Json now{{"base", m_base}, {"path", path}, {"is_saved", is_saved}};
    WEAVE_CHECK_OK(write_file(m_path / "now", now.dump(-1, ' ', false, Json::error_handler_t::replace)));
    WEAVE_CHECK_OK(open_journal());
    if (old.empty()) return {};
    std::error_code ignored;
    std::filesystem::remove(m_path / (old + ".weave"), ignored);
    std::filesystem::remove(m_path / (old + ".journal"), ignored);
    return {};
}

Status JournalFolder::open_journal() {
    if (m_journal >= 0) close(m_journal);
    m_journal = open((m_path / (m_base + ".journal")).c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
    if (m_journal < 0) return disk_error("the journal of unsaved work cannot be opened", m_path);
    return {};
}

Status JournalFolder::resume(std::size_t bytes) {
    WEAVE_TRY(const Now now, read_now(m_path));
    m_base = now.base;
    WEAVE_CHECK_OK(open_journal());
    if (ftruncate(m_journal, static_cast<off_t>(bytes)) != 0) return disk_error("the journal of unsaved work cannot be mended", m_path);
    return {};
}

Status JournalFolder::add(std::string_view line) {
    while (!line.empty()) {
        const ssize_t written = write(m_journal, line.data(), line.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return disk_error("unsaved work cannot be kept on the disk", m_path);
        line.remove_prefix(static_cast<std::size_t>(written));
    }
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
    WEAVE_TRY(const Now now, read_now(m_path));
    Content content;
    WEAVE_TRY(content.base, load_design(m_path / (now.base + ".weave")));
    WEAVE_TRY(content.journal, read_file(m_path / (now.base + ".journal"), most_journal_bytes));
    content.path = now.path;
    content.base_was_saved = now.is_saved;
    return content;
}

}  // namespace weave::studio
