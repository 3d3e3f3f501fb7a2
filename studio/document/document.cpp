#include <studio/document/document.hpp>

#include <weave/core/log.hpp>

#include <QFileInfo>
#include <QUndoCommand>

#include <utility>

namespace weave::studio {

/// A step on the undo stack. It was made before it came there.
class Document::StepCommand : public QUndoCommand {
  public:
    StepCommand(Document& document, const EditStep& step, std::vector<Edit> inverses)
        : QUndoCommand(step.text), m_document(document), m_step(step), m_inverses(std::move(inverses)),
          m_shown(document.shown_block()), m_generation(document.m_generation), m_stroke(document.m_stroke),
          m_state(++document.m_last_state) {}

    /// As the journal has it when it is undone or redone: by itself, unless its step is in the journal as one.
    [[nodiscard]] JournalEntry undo_entry() const { return entry<Undone>(m_inverses); }
    [[nodiscard]] JournalEntry redo_entry() const { return entry<Redone>(m_step.edits); }
    [[nodiscard]] std::uint64_t state() const { return m_state; }
    [[nodiscard]] bool is_stroke() const { return !m_step.key.isEmpty() && m_stroke == m_document.m_stroke; }

    void undo() override {
        const std::string left = m_document.shown_block();
        make(m_inverses);
        if (!m_document.design().blocks.contains(left)) m_made = left;
        m_document.note_change(m_shown);
    }
    void redo() override {
        if (!std::exchange(m_is_made, true)) return;
        make(m_step.edits);
        m_document.note_change(m_made.empty() ? m_shown : m_made);
    }
    [[nodiscard]] int id() const override { return m_step.key.isEmpty() ? -1 : 1; }
    bool mergeWith(const QUndoCommand* other) override {
        const auto* later = dynamic_cast<const StepCommand*>(other);
        if (later == nullptr || later->m_step.key != m_step.key || later->m_stroke != m_stroke) return false;
        m_step = later->m_step;
        m_state = later->m_state;
        return true;
    }

  private:
    template <class Short>
    [[nodiscard]] JournalEntry entry(const std::vector<Edit>& edits) const {
        if (m_generation == m_document.m_generation) return Short{};
        return EditStep{m_step.text, edits};
    }
    void make(const std::vector<Edit>& edits) {
        std::vector<Edit> ignored;
        if (Status made = m_document.make(edits, ignored); !made) log(LogLevel::warning, "a step cannot be repeated: " + made.error().text());
    }

    Document& m_document;
    EditStep m_step;
    std::vector<Edit> m_inverses;  ///< in the order in which they undo the step
    std::string m_shown;           ///< block in which it was made: undone or redone, it is seen there
    std::string m_made;            ///< block that it made and that was shown then
    bool m_is_made = false;
    std::uint64_t m_generation;  ///< of the document's journal when it was made
    std::uint64_t m_stroke, m_state;
};

Document::Document(Design design, const QString& path, bool is_saved, const std::filesystem::path& recoveries)
    : m_design(std::move(design)), m_path(path), m_keeper(recoveries, this) {
    if (!is_saved) m_saved_state.reset();
    m_keeper.begin(m_design, m_path, is_saved);
    m_focus.show_block(m_design.root);
    hear_of_blocks();
    connect_parts();
    ask_for_cloth();
}

Document::Document(Recovery recovery, const std::filesystem::path& recoveries)
    : m_design(std::move(recovery.base)), m_path(recovery.path), m_keeper(recoveries, this) {
    if (!recovery.base_was_saved) m_saved_state.reset();
    recovery.base = m_design;  // the keeper asks what the file held
    m_focus.show_block(m_design.root);
    hear_of_blocks();  // before the first is made, as one is for each step that is undone: what was told once is not told again
    replay(recovery.entries);
    m_keeper.resume(recovery);
    end_stroke();  // nobody draws on what another program began
    connect_parts();
    ask_for_cloth();
}

Document::~Document() {
    m_undo.blockSignals(true);  // it tells that it becomes empty, to a window that may be going as well
}

void Document::hear_of_blocks() {
    connect(&m_maker, &ClothMaker::made, this, &Document::take);
}

void Document::connect_parts() {
    connect(&m_focus, &Focus::block_changed, this, &Document::ask_for_cloth);
    connect(&m_focus, &Focus::block_changed, this, [this] { m_keeper.record(BlockShown{m_focus.block()}); });
    connect(&m_keeper, &Keeper::saved, this, [this](const QString& path) {
        end_save(true);
        if (path == m_path) return;
        m_path = path;
        Q_EMIT path_changed();
    });
    connect(&m_keeper, &Keeper::not_saved, this, [this] { end_save(false); });
    connect(&m_keeper, &Keeper::changed_outside, this, [this] { end_save(false); });
}

QString Document::name() const {
    if (!m_design.title.empty()) return QString::fromStdString(m_design.title);
    return m_path.isEmpty() ? tr("Untitled") : QFileInfo(m_path).completeBaseName();
}

// ---- Editing ----

Status Document::make(const std::vector<Edit>& edits, std::vector<Edit>& inverses) {
    inverses.clear();
    for (const Edit& edit : edits) {
        auto inverse = apply_edit(m_design, edit);
        if (!inverse) {
            for (const Edit& undone : inverses) {
                if (auto restored = apply_edit(m_design, undone); !restored) log(LogLevel::warning, restored.error().text());
            }
            return std::move(inverse).error();
        }
        inverses.insert(inverses.begin(), std::move(*inverse));
    }
    return {};
}

Status Document::push(const EditStep& step) {
    std::vector<Edit> inverses;
    WEAVE_CHECK_OK(make(step.edits, inverses));
    m_undo.push(std::make_unique<StepCommand>(*this, step, std::move(inverses)).release());
    return {};
}

Status Document::perform(const EditStep& step) {
    if (step.edits.empty()) return {};
    WEAVE_CHECK_OK(push(step));
    m_keeper.record(step);
    note_change();
    Q_EMIT modified_changed();
    return {};
}

void Document::undo() {
    if (m_undo.canUndo()) go(m_undo.index() - 1, &StepCommand::undo_entry, &QUndoStack::undo);
}

void Document::redo() {
    if (m_undo.canRedo()) go(m_undo.index(), &StepCommand::redo_entry, &QUndoStack::redo);
}

/// A journal that begins anew at a save knows nothing of earlier steps. Undoing one of those is told to it as a step, and from
/// then on the stack that replaying it would make is another one than this: all steps so far are told to it so.
void Document::go(int index, JournalEntry (StepCommand::*entry)() const, void (QUndoStack::*move)()) {
    end_stroke();
    const JournalEntry told = (command(index)->*entry)();
    if (std::holds_alternative<EditStep>(told)) ++m_generation;
    m_keeper.record(told);
    (m_undo.*move)();
    ++m_stroke;  // what was undone or redone is not drawn on
    Q_EMIT modified_changed();
}

void Document::end_stroke() {
    if (m_undo.index() == 0 || !command(m_undo.index() - 1)->is_stroke()) return;
    ++m_stroke;
    m_keeper.record(StrokeEnd{});
}

const Document::StepCommand* Document::command(int index) const {
    return static_cast<const StepCommand*>(m_undo.command(index));
}

std::uint64_t Document::state() const {
    return m_undo.index() == 0 ? 0 : command(m_undo.index() - 1)->state();
}

void Document::replay(const std::vector<JournalEntry>& entries) {
    for (const JournalEntry& entry : entries) {
        if (const auto* step = std::get_if<EditStep>(&entry)) {
            if (Status made = push(*step); !made) log(LogLevel::warning, "a step of unsaved work does not apply: " + made.error().text());
        } else if (const auto* shown = std::get_if<BlockShown>(&entry)) {
            if (m_design.blocks.contains(shown->block)) m_focus.show_block(shown->block);
        } else {
            if (std::holds_alternative<Undone>(entry)) m_undo.undo();
            if (std::holds_alternative<Redone>(entry)) m_undo.redo();
            ++m_stroke;
        }
    }
    if (!m_design.blocks.contains(m_focus.block())) m_focus.show_block(m_design.root);
}

/// `shown`: block to be shown, where there is one of this name.
void Document::note_change(const std::string& shown) {
    ++m_revision;
    if (m_design.blocks.contains(shown)) m_focus.show_block(shown);
    if (!m_design.blocks.contains(m_focus.block())) m_focus.show_block(m_design.root);
    ask_for_cloth();
    Q_EMIT edited();
}

// ---- What the blocks come to ----

void Document::ask_for_cloth() {
    m_maker.make(m_design, m_revision, m_focus.block());
}

void Document::take(const QString& block, const Cloth& cloth) {
    const std::string name = block.toStdString();
    if (!cloth.thumbnail.isNull()) m_thumbnails[name] = cloth.thumbnail;
    if (cloth.block) m_grids.insert_or_assign(name, cloth.block->grid());
    else m_grids.erase(name);
    if (name == m_focus.block()) {
        const bool is_other = m_shown_block != name;
        m_shown = cloth;
        if (is_other) m_shown.changed_cells.reset();
        m_shown_block = name;
        Q_EMIT shown_made();
    }
    if (name == m_design.root) {
        m_whole = cloth;
        Q_EMIT whole_made();
    }
    Q_EMIT block_made(block);
}

QImage Document::thumbnail_of(const std::string& block) const {
    const auto found = m_thumbnails.find(block);
    return found == m_thumbnails.end() ? QImage() : found->second;
}

const BlockGrid* Document::grid_of(const std::string& block) const {
    const auto found = m_grids.find(block);
    return found == m_grids.end() ? nullptr : &found->second;
}

// ---- The file ----

void Document::save(const QString& path, Keeper::Overwrite what) {
    end_stroke();  // what is saved can be come back to
    m_saving.push_back(state());
    ++m_generation;
    m_keeper.save(m_design, path, m_focus.block(), what);
    Q_EMIT modified_changed();
}

/// Not saved: nobody knows what the file holds now.
void Document::end_save(bool is_saved) {
    m_saved_state.reset();
    if (is_saved) m_saved_state = m_saving.front();
    m_saving.pop_front();
    Q_EMIT modified_changed();
}

}  // namespace weave::studio
