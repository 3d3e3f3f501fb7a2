#include <studio/window/stencil_desk.hpp>

#include <weave/design/tree.hpp>

#include <algorithm>
#include <studio/commands/change_block.hpp>

namespace weave::studio {

StencilDesk::StencilDesk(StencilEditor& editor, QObject* parent) : QObject(parent), m_editor(editor) {
    connect(&editor, &StencilEditor::edited, this, [this](const StencilOperation& operation, const QString& what) {
        if (m_document == nullptr || m_shown_block.empty()) return;
        const Status made = m_document->perform(change_block(m_document->design(), m_shown_block, operation, what));
        if (!made) Q_EMIT failed(QString::fromStdString(made.error().text()));
    });
}

void StencilDesk::show_document(Document* document) {
    if (m_document != nullptr) {
        m_document->disconnect(this);
        m_document->focus().disconnect(this);
    }
    m_document = document;
    m_shown_block.clear();
    m_editor.drop_questions();
    if (document == nullptr) return;
    connect(document, &Document::edited, this, &StencilDesk::show_block);
    connect(document, &Document::block_made, this, &StencilDesk::note_made);
    connect(&document->focus(), &Focus::block_changed, this, &StencilDesk::show_block);
    show_block();
}

void StencilDesk::show_block() {
    const Design& design = m_document->design();
    const auto found = design.blocks.find(m_document->shown_block());
    const auto* stencil = found == design.blocks.end() ? nullptr : std::get_if<StencilOperation>(&found->second->source);
    Q_EMIT is_stencil(stencil != nullptr);
    const std::string shown = stencil == nullptr ? std::string() : found->first;
    const bool is_other = shown != m_shown_block;
    m_shown_block = shown;
    if (is_other) m_editor.drop_questions();
    if (stencil == nullptr) return;
    // Most edits, such as flips, leave the stencil as it is.
    if (!is_other && m_shown.map == stencil->map && m_shown.of == stencil->of) return;
    m_shown = *stencil;
    list_blocks();
    m_editor.show_operation(*stencil);
}

/// A block came that may stand in the palette: not the stencil itself, nor what is made from it.
void StencilDesk::note_made(const QString& block) {
    if (!m_shown_block.empty() && block.toStdString() != m_shown_block) list_blocks();
}

void StencilDesk::list_blocks() {
    const Design& design = m_document->design();
    const std::string& shown = m_document->shown_block();
    const auto found = design.blocks.find(shown);
    if (found == design.blocks.end() || !std::holds_alternative<StencilOperation>(found->second->source)) return;
    std::vector<BlockChoice> choices;
    for (const auto& [name, node] : design.blocks) {
        if (name == shown) continue;
        BlockChoice choice{QString::fromStdString(name), QPixmap::fromImage(m_document->thumbnail_of(name)), {}, {}, {}};
        const std::vector<std::string> parts = bottom_up(design, name);
        if (std::find(parts.begin(), parts.end(), shown) != parts.end()) choice.reason = tr("it is made from this stencil");
        if (const BlockGrid* grid = m_document->grid_of(name)) choice.t = grid->t(), choice.p = grid->p();
        else if (choice.reason.isEmpty()) choice.reason = tr("it cannot be made");
        choices.push_back(std::move(choice));
    }
    m_editor.set_blocks(std::move(choices));
}

}  // namespace weave::studio
