#pragma once

#include <weave/block/stack.hpp>
#include <weave/design/outline.hpp>

#include <QObject>

#include <studio/document/document.hpp>
#include <studio/editors/slice_editor.hpp>

namespace weave::studio {

/// Brings the block that is shown into the slice editor, to draw where it is a drawn slice and to read where it is not, and what is done
/// there to the document. While the editor is not seen nothing is brought.
class SliceDesk : public QObject {
    Q_OBJECT
  public:
    SliceDesk(SliceEditor& editor, QObject* parent);

    void show_document(Document* document);
    /// Of a block that is no drawing: the column of an end (dots are wefts), or the row of a pick (dots are warps).
    void show_section(System dots, const CardPlace& place);

  Q_SIGNALS:
    void failed(const QString& reason);
    void flip_wanted(const weave::CardPlace& place);

  protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

  private:
    void show_block();
    void show_read(const BlockPtr& block);

    SliceEditor& m_editor;
    Document* m_document = nullptr;
    System m_dots = System::weft;
    bool m_goes_there = false;  ///< the section was asked for at the place of the focus
};

}  // namespace weave::studio
