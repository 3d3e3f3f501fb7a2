#pragma once

#include <QWidget>

class QLabel;
class QLineEdit;
class QPlainTextEdit;
class QProgressBar;
class QPushButton;

namespace weave::studio {

class TroubleLabel;

/// The note to a revision, the password that signs a submission, and the buttons that save and submit; while
/// something is on its way to the mill, how far it is, and a way to give it up.
class HandInForm : public QWidget {
    Q_OBJECT
  public:
    explicit HandInForm(QWidget* parent = nullptr);

    /// Why saving and submitting are not possible now; empty: they are. `submit` is what the button does.
    void set_hindrances(const QString& saving, const QString& submitting, const QString& submit);
    /// What is to be known before: the design has errors. Empty: nothing.
    void warn(const QString& words);
    void set_busy(bool busy);
    void set_progress(qint64 sent, qint64 of);
    /// Words about what was done.
    void tell(const QString& words);
    /// The submission was refused: the password that signs it is to be typed again.
    void ask_password();
    /// The note has gone into a revision.
    void clear_note();
    [[nodiscard]] QString note() const;

  Q_SIGNALS:
    void save_wanted(const QString& note);
    void submit_wanted(const QString& note, const QString& password);
    void cancel_wanted();

  private:
    void judge();

    QPlainTextEdit* m_note;
    QLineEdit* m_password;
    QPushButton *m_save, *m_submit, *m_cancel;
    TroubleLabel* m_warning;
    QLabel *m_hint, *m_told, *m_way;
    QProgressBar* m_progress;
    QString m_no_saving, m_no_submitting;
    bool m_busy = false;
};

}  // namespace weave::studio
