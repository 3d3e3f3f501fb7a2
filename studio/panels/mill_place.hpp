#pragma once

#include <QWidget>

#include <string>
#include <studio/jobs/mill_values.hpp>
#include <vector>

class QComboBox;
class QLabel;
class QLineEdit;
class QPushButton;

namespace weave::studio {

class SignInForm;

/// Where a design goes: the mill and the person, or a form to sign in; then the design's name there, one that
/// stands or a new one, and its branch where there are several.
class MillPlace : public QWidget {
    Q_OBJECT
  public:
    explicit MillPlace(QWidget* parent = nullptr);

    void show_access(const MillAccess& access);
    void show_designs(const std::vector<wire::MillDesign>& designs);
    /// What has become of a design, which the list of designs tells but now and then.
    void show_newest(const wire::MillHistory& history);
    void show_branches(const std::vector<wire::MillBranch>& branches);
    /// The name that is meant if the person chose none: the design of this name, or a new one.
    void suggest(const QString& name);
    /// The same for the design that is open already, whose name has changed: what the person chose stays.
    void suggest_anew(const QString& name);
    /// A new design was made at the mill under this name.
    void take_made(const QString& name);

    [[nodiscard]] bool is_new() const;
    /// Empty where no name is chosen that a mill takes.
    [[nodiscard]] QString design() const;
    [[nodiscard]] QString branch() const;
    [[nodiscard]] SignInForm& form() { return *m_form; }

  Q_SIGNALS:
    void sign_out_wanted();
    /// Another design is meant, or a new one under another name.
    void design_changed();
    void branch_changed();

  private:
    void fill(const QString& chosen);
    void choose(const QString& name);

    SignInForm* m_form;
    QWidget* m_place;
    QLabel *m_who, *m_branch_title, *m_name_title;
    QComboBox *m_designs, *m_branches;
    QLineEdit* m_name;
    std::vector<wire::MillDesign> m_known;
    QString m_suggested;
    bool m_chosen = false;  ///< by the person
};

}  // namespace weave::studio
