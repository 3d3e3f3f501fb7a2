#pragma once

#include <QObject>

#include <studio/document/document.hpp>
#include <studio/editors/stencil_editor.hpp>

namespace weave::studio {

/// Brings the block that is shown into the stencil editor where it is a stencil, and what is painted there to the document.
class StencilDesk : public QObject {
    Q_OBJECT
  public:
    StencilDesk(StencilEditor& editor, QObject* parent);

    void show_document(Document* document);

  Q_SIGNALS:
    void failed(const QString& reason);
    /// Whether the block that is shown is a stencil.
    void is_stencil(bool is);

  private:
    void show_block();
    void list_blocks();
    void note_made(const QString& block);

    StencilEditor& m_editor;
    Document* m_document = nullptr;
    std::string m_shown_block;
    StencilOperation m_shown;  ///< its map is compared by where it is
};

}  // namespace weave::studio
