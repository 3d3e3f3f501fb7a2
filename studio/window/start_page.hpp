#pragma once

#include <QWidget>

class QGridLayout;
class QListWidget;
class QListWidgetItem;
class QVBoxLayout;

namespace weave::studio {

/// What a person sees before there is a design: ways to begin one, those of late, and samples with their pictures.
class StartPage : public QWidget {
    Q_OBJECT
  public:
    explicit StartPage(QWidget* parent = nullptr);

    /// The designs that were open of late; their pictures, and which files are missing, follow: a share may take its time.
    void list_recent();

  Q_SIGNALS:
    void weave_wanted();
    void drawing_wanted();
    void open_wanted();
    void tutorial_wanted();
    void file_wanted(const QString& path);
    void sample_wanted(const QString& name);

  private:
    void add_beginnings(QVBoxLayout& column);
    void add_samples(QVBoxLayout& column);
    void add_recent(QVBoxLayout& column);
    void picture_sample(const QString& name);
    void look_for(const QString& path);
    void show_found(const QString& path, bool is_there, const QImage& picture);
    void ask_about(const QListWidgetItem* item, const QPoint& where);

    QListWidget* m_recent;
    QListWidget* m_samples;
};

}  // namespace weave::studio
