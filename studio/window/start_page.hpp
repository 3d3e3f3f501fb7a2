#pragma once

#include <QWidget>

class QGridLayout;
class QListWidget;
class QVBoxLayout;

namespace weave::studio {

/// What a person sees before there is a design: ways to begin one, those of late, and samples with their pictures.
class StartPage : public QWidget {
    Q_OBJECT
  public:
    explicit StartPage(QWidget* parent = nullptr);

    /// The designs that were open of late, latest first, as files.
    void list_recent(const QStringList& paths);

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
    void picture_sample(const QString& name);

    QListWidget* m_recent;
    QListWidget* m_samples;
};

}  // namespace weave::studio
