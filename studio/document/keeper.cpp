#include <studio/document/keeper.hpp>

#include <weave/core/log.hpp>

#include <QStandardPaths>
#include <QTimer>

#include <algorithm>
#include <chrono>
#include <new>
#include <optional>
#include <studio/document/design_file.hpp>
#include <studio/document/journal_writer.hpp>
#include <utility>

namespace weave::studio {

using namespace std::chrono_literals;

namespace {

QString words(const Error& error) {
    return QString::fromStdString(error.text());
}

/// What `deed` comes to, where memory may end within it.
template <class Deed>
Status tried(const Deed& deed) {
    try {
        return deed();
    } catch (const std::bad_alloc&) {
        return system_fault("there is not enough memory to keep the design");
    }
}

Status all_written(JournalWriter& journal) {
    WEAVE_CHECK_OK(journal.catch_up());
    return journal.sync();
}

}  // namespace

Keeper::Keeper(std::filesystem::path recoveries, QObject* parent)
    : QObject(parent), m_journal(std::make_unique<JournalWriter>(std::move(recoveries))), m_file(std::make_unique<DesignFile>()) {
    m_journal_thread.ask([this] {
        m_soon = std::make_unique<QTimer>();
        m_soon->setSingleShot(true);
        m_soon->setInterval(500ms);
        QObject::connect(m_soon.get(), &QTimer::timeout, m_soon.get(), [this] { come_back(); });
    });
}

Keeper::~Keeper() {
    m_file_thread.flush();  // what it comes to is for the journal
    m_journal_thread.ask([this] {
        m_soon.reset();
        const Status kept = tried([&] { return all_written(*m_journal); });
        if (!kept) log(LogLevel::warning, kept.error().text());
    });
    m_journal_thread.flush();
}

/// Does something with the journal, in its thread.
void Keeper::keep(std::function<Status(JournalWriter&)> deed) {
    m_journal_thread.ask([this, deed = std::move(deed)] {
        tell(tried([&] { return deed(*m_journal); }));
        if (m_journal->has_work() && !m_soon->isActive()) m_soon->start();
    });
}

void Keeper::come_back() {
    const bool was_in_trouble = m_is_in_trouble;
    const Status kept = tried([&] { return all_written(*m_journal); });
    if (kept || !was_in_trouble) tell(kept);  // the same trouble is not told twice a second
    if (m_journal->has_work()) m_soon->start();
}

void Keeper::tell(const Status& kept) {
    if (!kept) {
        m_is_in_trouble = true;
        Q_EMIT trouble(words(kept.error()));
    } else if (m_is_in_trouble && !m_journal->is_behind()) {
        m_is_in_trouble = false;
        Q_EMIT kept_again();
    }
}

void Keeper::begin(const Design& design, const QString& path, bool is_saved) {
    keep([design, path = path.toStdString(), is_saved](JournalWriter& journal) { return journal.begin(design, path, is_saved); });
    if (is_saved && !path.isEmpty()) m_file_thread.ask([this, design, path = path.toStdString()] { m_file->note(path, design); });
}

void Keeper::resume(const Recovery& recovery) {
    keep([folder = recovery.folder, bytes = recovery.journal_bytes](JournalWriter& journal) { return journal.resume(folder, bytes); });
    if (recovery.base_was_saved && !recovery.path.isEmpty())
        m_file_thread.ask([this, base = recovery.base, path = recovery.path.toStdString()] { m_file->note(path, base); });
}

void Keeper::record(const JournalEntry& entry) {
    keep([entry](JournalWriter& journal) { return journal.add(entry); });
}

void Keeper::save(const Design& design, const QString& path, const std::string& shown, Overwrite what) {
    keep([shown](JournalWriter& journal) -> Status {
        journal.begin_save(BlockShown{shown});
        return {};
    });
    m_file_thread.ask([this, design, path, what] {
        bool was_changed = false;
        const Status done = tried([&]() -> Status {
            was_changed = what == Overwrite::what_is_known && m_file->was_changed(path.toStdString());
            return was_changed ? Status() : m_file->save(path.toStdString(), design);
        });
        if (done && !was_changed) {
            keep([design, path](JournalWriter& journal) { return journal.end_save(design, path.toStdString()); });
            return Q_EMIT saved(path);
        }
        keep([](JournalWriter& journal) -> Status {
            journal.fail_save();
            return {};
        });
        if (was_changed) return Q_EMIT changed_outside(path);
        Q_EMIT not_saved(path, words(done.error()));
    });
}

void Keeper::discard() {
    keep([](JournalWriter& journal) -> Status {
        journal.remove();
        return {};
    });
}

void Keeper::flush() {
    m_file_thread.flush();
    m_journal_thread.flush();
}

// ---- What ended programs left ----

namespace {

std::vector<std::filesystem::path> folders_in(const std::filesystem::path& recoveries) {
    std::error_code trouble;
    std::vector<std::filesystem::path> folders;
    for (std::filesystem::directory_iterator each(recoveries, trouble), end; !trouble && each != end; each.increment(trouble)) {
        if (each->is_directory(trouble) && each->path().extension() != ".broken") folders.push_back(each->path());
    }
    return folders;
}

std::filesystem::path beside(const std::filesystem::path& folder) {
    return folder.string() + ".broken";
}

QString moved_aside(const std::filesystem::path& folder) {
    std::error_code trouble;
    std::filesystem::rename(folder, beside(folder), trouble);
    return QString::fromStdString((trouble ? folder : beside(folder)).string());
}

/// Whether a copy of a folder as it was found is beside it.
bool is_copied_aside(const std::filesystem::path& folder) {
    std::error_code trouble, ignored;
    std::filesystem::copy(folder, beside(folder), std::filesystem::copy_options::recursive | std::filesystem::copy_options::overwrite_existing, trouble);
    if (trouble) std::filesystem::remove_all(beside(folder), ignored);
    return !trouble;
}

/// What there is to recover in a folder, if anything.
std::optional<Recovery> recovery_in(std::shared_ptr<JournalFolder> folder, QStringList& aside) {
    const std::filesystem::path place = folder->path();
    auto content = folder->read();
    if (!content) {
        log(LogLevel::warning, "unsaved work could not be read: " + content.error().text());
        aside.push_back(moved_aside(place));
        return std::nullopt;
    }
    ReadJournal read = read_journal(content->journal);
    if (!read.is_understood) {
        const bool is_copied = is_copied_aside(place);
        aside.push_back(is_copied ? QString::fromStdString(beside(place).string()) : moved_aside(place));
        if (!is_copied) return std::nullopt;
    }
    if (content->base_was_saved && std::none_of(read.entries.begin(), read.entries.end(), is_of_design)) {
        folder->remove();
        return std::nullopt;
    }
    return Recovery{QString::fromStdString(content->path), std::move(content->base), content->base_was_saved, std::move(read.entries), read.bytes, std::move(folder)};
}

}  // namespace

std::filesystem::path Keeper::usual_folder() {
    return QStandardPaths::writableLocation(QStandardPaths::AppLocalDataLocation).toStdString() + "/unsaved";
}

Recoveries Keeper::take_recoveries(const std::filesystem::path& recoveries) {
    Recoveries taken;
    for (const std::filesystem::path& path : folders_in(recoveries)) {
        auto folder = JournalFolder::take(path);
        if (!folder) continue;
        auto recovery = recovery_in(std::make_shared<JournalFolder>(std::move(*folder)), taken.set_aside);
        if (recovery) taken.found.push_back(std::move(*recovery));
    }
    return taken;
}

}  // namespace weave::studio
