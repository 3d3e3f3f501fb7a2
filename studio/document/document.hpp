#pragma once

#include <weave/design/design.hpp>
#include <weave/design/edit.hpp>

#include <QObject>
#include <QString>
#include <QUndoStack>

#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <studio/document/cloth.hpp>
#include <studio/document/cloth_maker.hpp>
#include <studio/document/edit_step.hpp>
#include <studio/document/focus.hpp>
#include <studio/document/keeper.hpp>

namespace weave::studio {

/// The design of a window with all that was done to it: every edit goes through perform(), can be undone, and is kept on
/// the disk from the moment it is made. What its blocks have come to follows in the background.
class Document : public QObject {
    Q_OBJECT
  public:
    /// A design opened from `path`, or a new one (empty path). `is_saved`: closing it would lose nothing.
    Document(Design design, const QString& path, bool is_saved, const std::filesystem::path& recoveries = Keeper::usual_folder());
    /// Goes on where a program was ended, undoing included. All that was done is done again, which may take its time: made in another
    /// thread, it is to be moved to that of its window.
    explicit Document(Recovery recovery, const std::filesystem::path& recoveries = Keeper::usual_folder());
    ~Document() override;

    [[nodiscard]] const Design& design() const { return m_design; }
    [[nodiscard]] const QString& path() const { return m_path; }
    /// As window titles have it: the design's title, else its file's name.
    [[nodiscard]] QString name() const;
    /// Whether its file holds something else than the design as it stands; until a save has ended, what it held before.
    [[nodiscard]] bool is_modified() const { return m_saved_state != state(); }
    [[nodiscard]] bool is_saving() const { return !m_saving.empty(); }
    /// Grows with each change of the design.
    [[nodiscard]] std::uint64_t revision() const { return m_revision; }

    /// Makes the edits of a step, all or none. Errors: those of apply_edit(); then the design is as it was.
    Status perform(const EditStep& step);
    void undo();
    void redo();
    /// What is drawn or typed came to its end: no later step takes the place of the last one.
    void end_stroke();
    /// For texts and states of actions; undo and redo go through this document.
    [[nodiscard]] const QUndoStack& undo_stack() const { return m_undo; }

    Focus& focus() { return m_focus; }
    /// Name of the block that editors show.
    [[nodiscard]] const std::string& shown_block() const { return m_focus.block(); }
    /// The block that is shown, as it was made last; it may be of an earlier revision.
    [[nodiscard]] const Cloth& shown() const { return m_shown; }
    /// Whether it is of the design as it stands.
    [[nodiscard]] bool shown_is_current() const { return m_shown.revision == m_revision && m_shown_block == m_focus.block(); }
    /// The cloth of the design, as it was made last.
    [[nodiscard]] const Cloth& whole() const { return m_whole; }
    [[nodiscard]] QImage thumbnail_of(const std::string& block) const;
    /// Picks of the rows and ends of the columns of a block, as it was made last; null where it was not.
    [[nodiscard]] const BlockGrid* grid_of(const std::string& block) const;

    /// Writes the file in the background; a signal of the keeper tells what came of it.
    void save(const QString& path, Keeper::Overwrite what = Keeper::Overwrite::what_is_known);
    /// Nothing of it is to be recovered: it was closed, saved or not.
    void discard() { m_keeper.discard(); }
    Keeper& keeper() { return m_keeper; }

  Q_SIGNALS:
    /// The design changed.
    void edited();
    /// is_modified() or is_saving() may have changed.
    void modified_changed();
    /// The block that is shown was made anew, or another one is shown.
    void shown_made();
    /// The design's own cloth was made anew.
    void whole_made();
    void block_made(const QString& block);
    void path_changed();

  private:
    class StepCommand;
    void hear_of_blocks();
    void connect_parts();
    void end_save(bool is_saved);
    [[nodiscard]] std::uint64_t state() const;
    [[nodiscard]] const StepCommand* command(int index) const;
    void go(int index, JournalEntry (StepCommand::*entry)() const, void (QUndoStack::*move)());
    void replay(const std::vector<JournalEntry>& entries);
    Status push(const EditStep& step);
    Status make(const std::vector<Edit>& edits, std::vector<Edit>& inverses);
    void note_change(const std::string& shown = {});
    void ask_for_cloth();
    void take(const QString& block, const Cloth& cloth);

    Design m_design;
    QString m_path;
    std::uint64_t m_revision = 1;
    std::uint64_t m_generation = 0;  ///< of the journal: steps of an earlier one are not in it as they stand on the stack
    std::uint64_t m_last_state = 0;  ///< each step has a number of its own, also one that took another's place
    std::optional<std::uint64_t> m_saved_state = 0;  ///< that the file holds; none: no state that there is
    std::deque<std::uint64_t> m_saving;              ///< states that are being saved
    std::uint64_t m_stroke = 0;
    QUndoStack m_undo{this};  // these go with it into another thread
    Focus m_focus{this};
    Cloth m_shown, m_whole;
    std::string m_shown_block;
    std::map<std::string, QImage> m_thumbnails;
    std::map<std::string, BlockGrid> m_grids;
    ClothMaker m_maker{this};
    Keeper m_keeper;
};

}  // namespace weave::studio
