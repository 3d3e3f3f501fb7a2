#pragma once

#include <weave/sim/execute.hpp>
#include <weave/sim/fabric.hpp>
#include <weave/sim/transition.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace weave::sim {

/// Contact samples with their halo, and for each own sample those that may touch it: every sample nearer than
/// the sum of the two radii and a skin, but for those of the same yarn within half a turn of it along the
/// yarn (π r). The list holds until a sample has moved by half the skin. A wider list of what may come near
/// each segment lasts longer, so that most lists are made from it and only few by sorting all samples anew.
template <class Real>
class Neighbours {
  public:
    /// `transition` tells which pairs are left out besides, and must live as long.
    Neighbours(const Fabric<Real>& fabric, const Executor& executor, const Transition<Real>& transition);

    /// Own samples are placed by the body PlaceSamples, then update() moves the halo along, and builds the
    /// list anew where it no longer holds.
    void update();
    /// Only the halo: the list is known to hold.
    void move_halo();
    /// Whether the list holds for where the samples are now.
    [[nodiscard]] bool holds() const;

    [[nodiscard]] SamplesView<Real> samples() {
        return {m_x.data(), m_y.data(), m_z.data(), m_weight.data(), m_radius.data()};
    }
    [[nodiscard]] const std::uint32_t* first() const { return m_first.data(); }
    [[nodiscard]] const std::uint32_t* others() const { return m_others.data(); }
    [[nodiscard]] std::size_t entries() const { return m_others.size(); }
    [[nodiscard]] std::size_t halo() const { return m_halo.size(); }
    [[nodiscard]] const HaloSample* halo_samples() const { return m_halo.data(); }
    /// The own sample that a sample is, or is an image of.
    [[nodiscard]] std::uint32_t own(std::uint32_t sample) const {
        return sample < m_own ? sample : m_halo[sample - m_own].of;
    }
    /// Whether two own samples are of one yarn.
    [[nodiscard]] bool are_of_one_yarn(std::size_t a, std::size_t b) const {
        return m_fabric.segment_places()[m_segment_of[a]].yarn == m_fabric.segment_places()[m_segment_of[b]].yarn;
    }
    /// How many periods away from its own sample a sample lies.
    [[nodiscard]] std::array<std::int16_t, 2> image(std::uint32_t sample) const {
        return sample < m_own ? std::array<std::int16_t, 2>{} : m_halo[sample - m_own].image;
    }
    [[nodiscard]] std::uint32_t segment_of(std::uint32_t own_sample) const {
        return m_segment_of[own_sample];
    }
    /// Weights of the own samples when the first list was made, or keep_first_weights() was called before: they decide which samples lie
    /// on one stretch of a yarn, and do not touch. Empty until then.
    [[nodiscard]] const std::vector<Real>& first_weights() const { return m_first_weight; }
    void keep_first_weights();
    /// Bumped by each rebuild.
    [[nodiscard]] std::size_t builds() const { return m_builds; }
    [[nodiscard]] double skin_mm() const { return m_skin; }
    [[nodiscard]] std::size_t bytes() const;

  private:
    struct Grid;
    struct Candidates;
    struct Box;
    static constexpr std::size_t at_once = 64;  ///< segments that a thread lists at once

    void build();
    void build_wide();
    void find_halo();
    [[nodiscard]] double gone_since(const std::vector<Real>& places) const;
    void keep_places(std::vector<Real>& places) const;
    [[nodiscard]] Box box_of(std::size_t segment) const;
    template <class Fill, class FirstOf>
    void join(std::size_t parts, std::vector<std::uint32_t>& first, std::vector<std::uint32_t>& all,
              const Fill& fill, const FirstOf& first_of) const;
    void list_candidates(const std::vector<Grid>& grids);
    void list_neighbours();
    void find_candidates(const std::vector<Grid>& grids, std::size_t segment,
                         std::vector<std::uint32_t>& found) const;
    void gather_candidates(std::size_t segment, Candidates& near) const;
    void list_near(std::uint32_t sample, const Candidates& candidates,
                   std::vector<std::uint32_t>& list) const;
    [[nodiscard]] bool same_stretch(std::size_t sample, std::uint32_t other) const;

    const Fabric<Real>& m_fabric;
    const Executor& m_executor;
    const Transition<Real>& m_transition;
    std::size_t m_own;
    double m_skin, m_wide_skin;
    std::vector<Real> m_x, m_y, m_z, m_weight, m_radius;
    std::vector<Real> m_built, m_wide_built;  ///< places when each list was made, x y z of own samples
    std::vector<Real> m_first_weight;
    std::vector<std::uint32_t> m_segment_of;
    std::vector<std::uint32_t> m_class_of_yarn;
    std::vector<double> m_classes;  ///< greatest radius of each class, rising
    std::vector<HaloSample> m_halo;
    std::vector<std::uint32_t> m_first, m_others;
    std::vector<std::uint32_t> m_first_candidate, m_candidates;  ///< of each segment, samples and images
    std::size_t m_builds = 0;
};

extern template class Neighbours<float>;
extern template class Neighbours<double>;

}  // namespace weave::sim
