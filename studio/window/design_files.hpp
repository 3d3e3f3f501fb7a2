#pragma once

#include <weave/design/design.hpp>

#include <QImage>
#include <QObject>
#include <QString>
#include <QStringList>
#include <QWidget>

#include <string>
#include <studio/document/document.hpp>
#include <studio/editors/coloured_picture.hpp>
#include <vector>

namespace weave::studio {

/// Opens, saves and exports designs for a window: the dialogs, and the reading in the background.
class DesignFiles : public QObject {
    Q_OBJECT
  public:
    explicit DesignFiles(QWidget* window);

    void open();
    void open_file(const QString& path);
    /// A design whose cloth is the stencil that a picture draws, each of its colours in one of these weaves.
    void make_stencil(const ColouredPicture& picture, const std::vector<std::string>& weaves, const QString& path);
    /// To its file, or asks for one; whether it is being saved.
    bool save(Document& document);
    bool save_as(Document& document);
    /// The card as a picture or WIF, by the ending that is chosen.
    void export_card(const Document& document);
    /// What is seen in space, as a PNG.
    void save_picture(const QImage& picture);

  Q_SIGNALS:
    /// `path` is empty where the design was made from a file of another kind, and is to be saved anew.
    void opened(const weave::Design& design, const QString& path, const QStringList& warnings);
    /// A file is no card, but a picture in colours.
    void coloured(const weave::studio::ColouredPicture& picture, const QString& path);
    void failed(const QString& reason);
    /// After failed(): a file is nothing that can be opened.
    void not_opened(const QString& reason);
    void told(const QString& words);

  private:
    void look_for_colours(const QString& path, const QString& reason);

    QWidget* m_window;
};

}  // namespace weave::studio
