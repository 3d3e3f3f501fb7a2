#include <studio/document/journal_writer.hpp>

#include <utility>

namespace weave::studio {

Status JournalWriter::begin(const Design& design, const std::string& path, bool is_saved) {
    return begin_behind([this, design, path, is_saved] { return m_folder->begin(design, path, is_saved); });
}

Status JournalWriter::resume(std::shared_ptr<JournalFolder> folder, std::uint64_t bytes) {
    m_folder = std::move(folder);
    return begin_behind([this, bytes] { return m_folder->resume(bytes); });
}

Status JournalWriter::begin_behind(std::function<Status()> base) {
    if (m_is_removed) return {};
    m_base = std::move(base);
    m_lines.clear();
    return catch_up();
}

Status JournalWriter::add(const JournalEntry& entry) {
    if (m_is_removed) return {};
    m_lines.push_back(journal_line(entry));
    for (std::string& lines : m_in_saves) lines += m_lines.back();
    return catch_up();
}

void JournalWriter::begin_save(const JournalEntry& shown) {
    m_in_saves.push_back(journal_line(shown));
}

Status JournalWriter::end_save(const Design& design, const std::string& path) {
    std::string lines = std::move(m_in_saves.front());
    m_in_saves.pop_front();
    return begin_behind([this, design, path, lines = std::move(lines)] { return m_folder->begin(design, path, true, lines); });
}

void JournalWriter::fail_save() {
    m_in_saves.pop_front();
}

Status JournalWriter::catch_up() {
    if (!is_behind()) return {};
    if (!m_folder) {
        WEAVE_TRY(JournalFolder made, JournalFolder::make(m_recoveries));
        m_folder = std::make_shared<JournalFolder>(std::move(made));
    }
    if (m_base) WEAVE_CHECK_OK(m_base());
    m_base = nullptr;
    for (; !m_lines.empty(); m_lines.pop_front()) {
        WEAVE_CHECK_OK(m_folder->add(m_lines.front()));
        m_is_dirty = true;
    }
    return {};
}

Status JournalWriter::sync() {
    return m_folder && std::exchange(m_is_dirty, false) ? m_folder->sync() : Status();
}

void JournalWriter::remove() {
    m_is_removed = true;
    m_is_dirty = false;
    m_base = nullptr;
    m_lines.clear();
    if (m_folder) m_folder->remove();
    m_folder.reset();
}

}  // namespace weave::studio
