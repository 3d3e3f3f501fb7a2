#pragma once

#include <weave/design/design.hpp>

#include <QImage>
#include <QObject>
#include <QString>
#include <QStringList>
#include <QWidget>

#include <studio/document/document.hpp>

namespace weave::studio {

/// Opens, saves and exports designs for a window: the dialogs, and the reading in the background.
class DesignFiles : public QObject {
    Q_OBJECT
  public:
    explicit DesignFiles(QWidget* window);

    void open();
    void open_file(const QString& path);
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
    void failed(const QString& reason);
    void told(const QString& words);

  private:
    QWidget* m_window;
};

}  // namespace weave::studio
