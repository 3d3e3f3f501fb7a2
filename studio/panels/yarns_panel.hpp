#pragma once

#include <weave/core/json.hpp>
#include <weave/design/design.hpp>

#include <QWidget>

#include <studio/document/document.hpp>

class QDoubleSpinBox;
class QLabel;
class QLineEdit;
class QPlainTextEdit;
class QTimer;

namespace weave::studio {

class YarnTable;

/// How the cloth is set up: title and notes, the yarns of warp and weft, their order over ends and picks, and densities. What is typed
/// becomes a step of the document once it is right; until then it says what is wrong.
class YarnsPanel : public QWidget {
    Q_OBJECT
  public:
    explicit YarnsPanel(QWidget* parent = nullptr);
    void show_document(Document* document);

  private:
    /// The fields of a system.
    struct Side {
        YarnTable* yarns = nullptr;
        QLineEdit* order = nullptr;
        QDoubleSpinBox* density = nullptr;
        double shown_density = 0;      ///< as the box rounds that of the design
        QLineEdit* feeders = nullptr;  ///< names of the weft's feeders with their yarns
    };
    QWidget* make_side(Side& side, bool is_warp);
    void show_plans();
    static void show_density(Side& side, double density);
    static double density_of(const Side& side, double before);
    void take_warp();
    void take_weft();
    void take_title();
    void tell(const Status& status);
    [[nodiscard]] bool is_right(QLineEdit& field, int count, bool is_of_feeders);

    Document* m_document = nullptr;
    QTimer* m_pause;  ///< of the typing; what is typed after one is a step of its own
    QLineEdit* m_title;
    QPlainTextEdit* m_notes;
    Side m_warp, m_weft;
    QLabel* m_trouble;
    bool m_is_filling = false;
};

}  // namespace weave::studio
