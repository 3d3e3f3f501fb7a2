#pragma once

#include <weave/block/preset.hpp>

#include <QDialog>

#include <map>
#include <string>

class QComboBox;
class QDialogButtonBox;
class QFormLayout;
class QLabel;
class QSpinBox;

namespace weave::studio {

/// Chooses a traditional weave by its rule, with a picture of what it will be.
class PresetDialog : public QDialog {
    Q_OBJECT
  public:
    explicit PresetDialog(QWidget* parent = nullptr);

    void set_preset(const Preset& preset);
    [[nodiscard]] Preset preset() const;

  private:
    void show_options();
    void try_out();

    QComboBox* m_families;
    QLabel* m_help;
    QFormLayout* m_form;
    QLabel* m_picture;
    QLabel* m_verdict;
    QDialogButtonBox* m_buttons;
    std::map<std::string, QSpinBox*> m_options;
};

}  // namespace weave::studio
