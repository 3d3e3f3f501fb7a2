#include <studio/window/slice_desk.hpp>

#include <QEvent>

#include <algorithm>
#include <studio/commands/change_block.hpp>
#include <utility>

namespace weave::studio {

SliceDesk::SliceDesk(SliceEditor& editor, QObject* parent) : QObject(parent), m_editor(editor) {
    editor.installEventFilter(this);
    connect(&editor, &SliceEditor::edited, this, [this](const Slice& slice, const QString& what) {
        if (m_document == nullptr) return;
        const std::string block = m_document->shown_block();
        const Status made = m_document->perform(change_block(m_document->design(), block, SliceLeaf{slice}, what));
        if (!made) Q_EMIT failed(QString::fromStdString(made.error().text()));
    });
    connect(&editor, &SliceEditor::flip_wanted, this, [this](std::size_t pick, std::size_t end) {
        if (m_document != nullptr) Q_EMIT flip_wanted({pick, end});
    });
}

void SliceDesk::show_document(Document* document) {
    if (m_document != nullptr) {
        m_document->disconnect(this);
        m_document->focus().disconnect(this);
    }
    m_document = document;
    if (document == nullptr) return;
    connect(document, &Document::edited, this, &SliceDesk::show_block);
    connect(document, &Document::shown_made, this, &SliceDesk::show_block);
    connect(&document->focus(), &Focus::block_changed, this, &SliceDesk::show_block);
    connect(&document->focus(), &Focus::place_changed, this, &SliceDesk::show_block);
    show_block();
}

void SliceDesk::show_section(System dots, const CardPlace& place) {
    m_dots = dots;
    m_goes_there = true;
    if (m_document != nullptr) m_document->focus().go_to(place);
}

bool SliceDesk::eventFilter(QObject* watched, QEvent* event) {
    if (watched == &m_editor && event->type() == QEvent::Show && m_document != nullptr) show_block();
    return QObject::eventFilter(watched, event);
}

void SliceDesk::show_block() {
    if (!m_editor.isVisible()) return;
    const Design& design = m_document->design();
    const auto found = design.blocks.find(m_document->shown_block());
    if (found == design.blocks.end()) return;
    if (const auto* leaf = std::get_if<SliceLeaf>(&found->second->source)) {
        m_goes_there = false;  // a drawing is shown whole
        m_editor.set_design(design);
        return m_editor.show_slice(leaf->slice);
    }
    if (const BlockPtr& block = m_document->shown().block; block && m_document->shown_is_current()) show_read(block);
}

void SliceDesk::show_read(const BlockPtr& block) {
    const CardPlace place = m_document->focus().place().value_or(CardPlace{});
    const std::size_t line = m_dots == System::weft ? block->column_of_end(std::min(place.end, block->ends() - 1))
                                                    : block->row_of_pick(std::min(place.pick, block->picks() - 1));
    if (std::exchange(m_goes_there, false)) m_editor.reader().go_to(place.pick, place.end);
    m_editor.show_block(m_document->design(), block, m_dots, line);
}

}  // namespace weave::studio
