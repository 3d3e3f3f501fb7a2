#pragma once

#include <weave/core/result.hpp>
#include <weave/design/design.hpp>

#include <QObject>
#include <QString>
#include <QStringList>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <studio/document/journal.hpp>
#include <studio/document/journal_folder.hpp>
#include <studio/document/task_thread.hpp>
#include <vector>

class QTimer;

namespace weave::studio {

class DesignFile;
class JournalWriter;

/// What a program that was ended left of a document that was not saved.
struct Recovery {
    QString path;  ///< of the file that was open; empty where there was none
    Design base;   ///< as it was opened or saved last
    bool base_was_saved = true;
    std::vector<JournalEntry> entries;  ///< since then
    std::size_t journal_bytes = 0;
    std::shared_ptr<JournalFolder> folder;  ///< where it lies until it is closed as its person wants it
};

/// All that ended programs left.
struct Recoveries {
    std::vector<Recovery> found;
    QStringList set_aside;  ///< folders of what could not be read, or not to its end
};

/// Keeps a document on the disk, so that no window waits for a disk: its journal, which outlives the program however it ends,
/// and its file when it is saved. Each has a thread of its own: however long a share takes to save, the journal goes on. What is
/// recorded reaches the system at once and the disk within half a second.
class Keeper : public QObject {
    Q_OBJECT
  public:
    enum class Overwrite : std::uint8_t { what_is_known, anything };

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
    /// recorded; `shown` is the block that is shown. Ends with saved(), changed_outside() or not_saved(), in the order asked for.
    void save(const Design& design, const QString& path, const std::string& shown, Overwrite what = Overwrite::what_is_known);
    /// The document was closed as its person wants it: nothing is to be recovered.
    void discard();
    /// Waits until all that was asked for is done; for tests, as a window must not.
    void flush();

    /// Where this person's journals are.
    static std::filesystem::path usual_folder();
    /// Takes over what ended programs left there; what running ones have is left alone. Of what cannot be read a copy is set
    /// aside (`.broken`).
    static Recoveries take_recoveries(const std::filesystem::path& recoveries);

  Q_SIGNALS:
    void saved(const QString& path);
    void not_saved(const QString& path, const QString& reason);
    /// It was not saved: the file is not as it was when this document read or wrote it.
    void changed_outside(const QString& path);
    /// The journal cannot be written: edits would be lost with the program. It is tried again until kept_again().
    void trouble(const QString& reason);
    void kept_again();

  private:
    void keep(std::function<Status(JournalWriter&)> deed);
    void come_back();
    void tell(const Status& kept);

    // Of the journal's thread alone.
    std::unique_ptr<JournalWriter> m_journal;
    std::unique_ptr<QTimer> m_soon;  ///< to what is not on the disk yet
    bool m_is_in_trouble = false;

    std::unique_ptr<DesignFile> m_file;  ///< of the file's thread alone
    TaskThread m_journal_thread, m_file_thread;
};

}  // namespace weave::studio
