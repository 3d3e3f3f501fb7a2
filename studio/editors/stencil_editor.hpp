#pragma once

#include <weave/design/design.hpp>
#include <studio/editors/coloured_picture.hpp>
#include <studio/editors/block_choice.hpp>
#include <studio/editors/stencil_canvas.hpp>
#include <studio/editors/stencil_palette.hpp>

#include <QActionGroup>
#include <QLabel>

#include <functional>
#include <memory>

namespace weave::studio {

/// The stencil editor: paints which block each stack of a cloth comes from. It knows no document: an
/// operation comes in, and every stroke, or change of palette or size, goes out as an edited one.
class StencilEditor : public QWidget {
    Q_OBJECT
  public:
    explicit StencilEditor(QWidget* parent = nullptr);
    [[nodiscard]] StencilCanvas& canvas() { return *m_canvas; }
    [[nodiscard]] StencilPalette& palette_list() { return *m_palette; }
    [[nodiscard]] const StencilOperation& operation() const { return m_operation; }

  public Q_SLOTS:
    void show_operation(const weave::StencilOperation& operation);
    /// The blocks of the design that may stand in the palette, with their counts.
    void set_blocks(std::vector<BlockChoice> blocks);
    /// Reads a picture, then asks for the blocks of its colours. What is wrong with it is told in words.
    void load_picture(const QString& path);
    void ask_size();
    /// Another stencil is shown, or none: a picture that is being read, and the dialogs, were about the last one.
    void drop_questions();

  Q_SIGNALS:
    void edited(const weave::StencilOperation& operation, const QString& what);
    void status(const QString& words);

  private:
    QWidget* make_tool_row();
    QAction* make_action(QWidget* row, const QString& name, const QString& text, const QString& tip,
                         const QKeySequence& keys);
    void make_tool(QWidget* row, StencilTool tool, const QString& name, const QString& text,
                   const QKeySequence& keys);
    void make_button(QWidget* row, const QString& name, const QString& text, const QString& tip,
                     const std::function<void()>& what);
    void choose_picture();
    /// Does work beside the window's thread, and what it returns in it, unless the editor is gone or asked
    /// for other work since.
    void make_beside(std::function<std::function<void()>()> work);
    void ask_blocks(const ColouredPicture& picture);
    /// `blocks` are those of the colours.
    void take_picture(const ColouredPicture& picture, const std::vector<std::string>& blocks);
    void add_block(const QString& name);
    void remove_entry(int entry);
    void move_entry(int entry, int step);
    void put(StencilOperation operation, const QString& what);
    void show_all();
    void choose_entry(int entry);
    [[nodiscard]] const BlockChoice* choice_of(const std::string& name) const;
    [[nodiscard]] bool has_map() const { return m_operation.map && m_operation.map->rows > 0; }
    /// Why these blocks cannot be in one stencil of this size; empty where they can.
    [[nodiscard]] QString obstacle(const std::vector<std::string>& names, std::size_t rows,
                                   std::size_t columns) const;
    [[nodiscard]] QString obstacle_beside_first(const std::string& name) const;
    [[nodiscard]] std::vector<BlockChoice> choices_beside_first() const;

    StencilOperation m_operation;
    std::vector<BlockChoice> m_blocks;
    StencilCanvas* m_canvas;
    StencilPalette* m_palette;
    QActionGroup* m_tools;
    QLabel *m_size, *m_trouble;
    std::size_t m_reading = 0;  ///< counts the pictures asked for, so that one read too late is let go
};

}  // namespace weave::studio
