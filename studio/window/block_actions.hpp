#pragma once

#include <weave/block/operations.hpp>
#include <weave/block/slice.hpp>

#include <QMenu>
#include <weave/block/from_card.hpp>

#include <QObject>

#include <functional>
#include <QWidget>

#include <string>
#include <studio/document/document.hpp>

namespace weave::studio {

/// What a drawing begins with: a section of four positions, each with a weft under the one warp.
Slice first_drawing();

/// What can be done to the blocks of a document: each asks what it has to, and makes one step that can be undone.
class BlockActions : public QObject {
    Q_OBJECT
  public:
    BlockActions(Document& document, QWidget* window);

    void add_weave();
    void add_drawing();
    void add_stencil();
    void change_weave(const std::string& block);
    /// Asks how many picks and ends of an imported card lie on top of one another.
    void ask_layers(const std::string& block);
    /// Says so where an imported card is likely to be of several layers.
    void look_for_layers(const std::string& block);
    void repeat(const std::string& block);
    void duplicate(const std::string& block);
    void rename(const std::string& from, const std::string& to);
    void ask_name(const std::string& block);
    void remove(const std::string& block);
    void make_the_cloth(const std::string& block);
    void attach(const std::string& block, const std::string& other, Face face);
    /// Asks with a menu which block is to come to a face, or to which face a block is to come.
    void ask_what_to_attach(const std::string& block, Face face, const QPoint& where);
    void ask_where_to_attach(const std::string& block, const std::string& other, const QPoint& where);
    /// The block with all that it is made from on the clipboard, and from there.
    void copy(const std::string& block);
    void paste();
    /// Everything above, for one block.
    void fill_menu(QMenu& menu, const std::string& block);

  Q_SIGNALS:
    void failed(const QString& reason);
    void told(const QString& words);
    /// A stencil was made, and is shown: it is to be painted.
    void stencil_begun();
    void drawing_begun();
    /// To be read when there is time.
    void noted(const QString& words);

  private:
    bool perform(const EditStep& step);
    bool add(const std::string& wish, NodeSource source);
    void find_groupings(const std::string& block, std::function<void(const CardLeaf& leaf, const std::vector<Grouping>& found)> then);

    Document& m_document;
    QWidget* m_window;
};

}  // namespace weave::studio
