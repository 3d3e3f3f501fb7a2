#pragma once

#include <QWidget>

class QLineEdit;
class QPushButton;

namespace weave::studio {

class TroubleLabel;

/// Asks for a mill and who the person is. The password is handed on and forgotten at once.
class SignInForm : public QWidget {
    Q_OBJECT
  public:
    explicit SignInForm(QWidget* parent = nullptr);

    /// What was used last, so that the password alone is left to type.
    void fill(const QString& origin, const QString& fingerprint, const QString& name);
    /// Why it did not work; empty: nothing is wrong.
    void complain(const QString& words);
    void set_busy(bool busy);

  Q_SIGNALS:
    void sign_in_wanted(const QString& origin, const QString& fingerprint, const QString& name,
                        const QString& password);

  private:
    void go();
    void judge();

    QLineEdit *m_origin, *m_fingerprint, *m_name, *m_password;
    QPushButton* m_go;
    TroubleLabel* m_words;
    bool m_busy = false;
};

}  // namespace weave::studio
