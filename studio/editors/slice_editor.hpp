#pragma once

#include <studio/editors/slice_edit_canvas.hpp>
#include <studio/editors/slice_reader.hpp>

#include <QStackedWidget>

namespace weave::studio {

/// The slice editor: draws a slice (a basis block), or shows a row or column of any block to read. It knows
/// no document: values come in, edited values go out, and whoever owns it makes commands of them.
class SliceEditor : public QWidget {
    Q_OBJECT
  public:
    explicit SliceEditor(QWidget* parent = nullptr);
    [[nodiscard]] SliceEditCanvas& canvas() { return *m_canvas; }
    [[nodiscard]] SliceReader& reader() { return *m_reader; }
    /// That of the page that is shown.
    [[nodiscard]] SliceCanvas& canvas_in_sight();

  public Q_SLOTS:
    /// Shows a drawn slice to edit. One that is shown already keeps view and choice, so the owner may answer
    /// every `edited` with the slice of its document.
    void show_slice(const weave::Slice& slice);
    /// The design that the slice belongs to: colours, feeders, and whether the weft wraps round.
    void set_design(const weave::Design& design);
    /// Shows column `line` (dots are wefts) or row `line` (dots are warps) of a block to read.
    void show_block(const weave::Design& design, weave::BlockPtr block, weave::System dots, std::size_t line);

  Q_SIGNALS:
    /// One gesture's result, and its name for the list of undo. It passes to_block().
    void edited(const weave::Slice& slice, const QString& what);
    /// What lies under the pointer, or why something cannot be done; empty for nothing.
    void status(const QString& words);
    /// In a block to read: a crossing was clicked whose flip can be made; from 0.
    void flip_wanted(std::size_t pick, std::size_t end);

  private:
    QWidget* make_tool_row();
    QWidget* make_begin_row();
    void begin(int positions);

    SliceEditCanvas* m_canvas;
    SliceReader* m_reader;
    QStackedWidget* m_pages;
    QWidget *m_tool_row, *m_begin_row;
};

}  // namespace weave::studio
