#pragma once

#include <weave/block/preset.hpp>

#include <QDialog>

#include <map>
#include <string>

class QCheckBox;
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
    [[nodiscard]] const PresetFamily& family() const;
    QWidget* make_field(const PresetOption& option);
    [[nodiscard]] std::int64_t value_of(const PresetOption& option) const;

    std::map<std::string, QSpinBox*> m_numbers;
    std::map<std::string, QCheckBox*> m_choices;  ///< options that are a yes or a no
};

}  // namespace weave::studio
