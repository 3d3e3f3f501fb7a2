#pragma once

#include <weave/core/result.hpp>
#include <weave/design/design.hpp>

#include <QObject>
#include <QString>

#include <condition_variable>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <studio/document/journal.hpp>
#include <studio/document/journal_folder.hpp>
#include <thread>

namespace weave::studio {

/// What a program that was ended left of a document that was not saved.
struct Recovery {
    QString path;  ///< of the file that was open; empty where there was none
    Design base;   ///< as it was opened or saved last
    bool base_was_saved = true;
    std::vector<JournalEntry> entries;  ///< since then
    std::size_t journal_bytes = 0;
    std::shared_ptr<JournalFolder> folder;  ///< where it lies until it is closed as its person wants it
};

/// Keeps a document on the disk, in a thread of its own, so that no window waits for a disk: its journal, which outlives
/// the program however it ends, and its file when it is saved. What is recorded reaches the system at once and the disk
/// within half a second.
class Keeper : public QObject {
    Q_OBJECT
  public:
    /// Keeps its journal in a new folder within `recoveries`. A folder that cannot be made is told by trouble().
    explicit Keeper(std::filesystem::path recoveries, QObject* parent = nullptr);
    /// Finishes what is asked for. Of a document that was not discarded the journal stays.
    ~Keeper() override;

    /// The document as it is from here on: opened from, or never saved to, `path`.
    void begin(const Design& design, const QString& path, bool is_saved);
    /// The same for work that was recovered: its journal goes on.
    void resume(const Recovery& recovery);
    void record(const JournalEntry& entry);
    /// Writes the file, whole or not at all; once it is written the journal begins anew behind it. `design` has all that was
    /// recorded. Ends with saved() or not_saved().
    void save(const Design& design, const QString& path);
    /// The document was closed as its person wants it: nothing is to be recovered.
    void discard();
    /// Waits until all that was asked for is done.
    void flush();

    /// Where this person's journals are.
    static std::filesystem::path usual_folder();
    /// Takes over what ended programs left there; what running ones have is left alone. What cannot be read is moved aside
    /// (`.broken`) and logged.
    static std::vector<Recovery> take_recoveries(const std::filesystem::path& recoveries);

  Q_SIGNALS:
    void saved(const QString& path);
    void not_saved(const QString& path, const QString& reason);
    /// The journal cannot be written: edits would be lost with the program.
    void trouble(const QString& reason);

  private:
    class Folder;
    void ask(std::function<void()> task);
    void work();

    std::unique_ptr<Folder> m_folder;  ///< of the thread
    std::mutex m_mutex;
    std::condition_variable m_came, m_done;
    std::deque<std::function<void()>> m_tasks;
    bool m_is_busy = false, m_ends = false;
    std::thread m_thread;
};

}  // namespace weave::studio
