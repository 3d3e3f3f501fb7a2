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
          m_generation(document.m_generation) {}

    /// As the journal has it when it is undone or redone: by itself, unless its step is in the journal as one.
    [[nodiscard]] JournalEntry undo_entry() const { return entry<Undone>(m_inverses); }
    [[nodiscard]] JournalEntry redo_entry() const { return entry<Redone>(m_step.edits); }

    void undo() override { make(m_inverses); }
    void redo() override {
        if (!std::exchange(m_is_made, true)) return;
        make(m_step.edits);
    }
    [[nodiscard]] int id() const override { return m_step.key.isEmpty() ? -1 : 1; }
    bool mergeWith(const QUndoCommand* other) override {
        const auto* later = dynamic_cast<const StepCommand*>(other);
        if (later == nullptr || later->m_step.key != m_step.key) return false;
        m_step = later->m_step;
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
        m_document.note_change();
    }

    Document& m_document;
    EditStep m_step;
    std::vector<Edit> m_inverses;  ///< in the order in which they undo the step
    bool m_is_made = false;
    std::uint64_t m_generation;  ///< of the document's journal when it was made
};

Document::Document(Design design, const QString& path, bool is_saved, const std::filesystem::path& recoveries)
    : m_design(std::move(design)), m_path(path), m_keeper(recoveries) {
    if (!is_saved) m_undo.resetClean();
    m_keeper.begin(m_design, m_path, is_saved);
    m_focus.show_block(m_design.root);
    connect_parts();
    ask_for_cloth();
}

Document::Document(Recovery recovery, const std::filesystem::path& recoveries)
    : m_design(std::move(recovery.base)), m_path(recovery.path), m_keeper(recoveries) {
    if (!recovery.base_was_saved) m_undo.resetClean();
    m_focus.show_block(m_design.root);
    replay(recovery.entries);
    m_keeper.resume(recovery);
    connect_parts();
    ask_for_cloth();
}

Document::~Document() {
    m_undo.blockSignals(true);  // it tells that it becomes empty, to a window that may be going as well
}

void Document::connect_parts() {
    connect(&m_maker, &ClothMaker::made, this, &Document::take);
    connect(&m_focus, &Focus::block_changed, this, &Document::ask_for_cloth);
    connect(&m_keeper, &Keeper::saved, this, [this](const QString& path) {
        if (path == m_path) return;
        m_path = path;
        Q_EMIT path_changed();
    });
    connect(&m_keeper, &Keeper::not_saved, &m_undo, &QUndoStack::resetClean);
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
void Document::go(int command, JournalEntry (StepCommand::*entry)() const, void (QUndoStack::*move)()) {
    const JournalEntry told = (static_cast<const StepCommand*>(m_undo.command(command))->*entry)();
    if (std::holds_alternative<EditStep>(told)) ++m_generation;
    m_keeper.record(told);
    (m_undo.*move)();
}

void Document::replay(const std::vector<JournalEntry>& entries) {
    for (const JournalEntry& entry : entries) {
        if (std::holds_alternative<Undone>(entry)) {
            m_undo.undo();
        } else if (std::holds_alternative<Redone>(entry)) {
            m_undo.redo();
        } else if (Status made = push(std::get<EditStep>(entry)); !made) {
            log(LogLevel::warning, "a step of unsaved work does not apply: " + made.error().text());
        }
    }
}

void Document::note_change() {
    ++m_revision;
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

void Document::save(const QString& path) {
    m_undo.setClean();
    ++m_generation;
    m_keeper.save(m_design, path);
}

}  // namespace weave::studio
