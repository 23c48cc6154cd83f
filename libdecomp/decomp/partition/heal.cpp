// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/partition/heal.h"

#include "decomp/mesh/measure.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace decomp::partition {

namespace {

using Areas = std::vector<std::map<std::size_t, double>>;

/// Area of contact of every atom with every other.
Areas contacts_of(const std::vector<Atom>& atoms) {
    std::map<std::int32_t, std::size_t> number;
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        number[atoms[i].region] = i;
    }
    Areas out(atoms.size());
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        const part::Part& part = atoms[i].part;
        for (std::size_t t = 0; t < part.sources.size(); ++t) {
            if (part.sources[t].is_cut()) {
                out[i][number.at(part.sources[t].neighbour)] +=
                    mesh::double_area_normal(part.mesh, t).norm() / 2;
            }
        }
    }
    return out;
}

/// Atoms of one label that hang together.
struct Piece {
    std::vector<std::size_t> atoms;
    double votes_mm3 = 0;
    double volume_mm3 = 0;
    double interface_mm2 = 0;
    std::map<std::int32_t, double> touching;  ///< area of contact by label
};

class Healer {
  public:
    Healer(const cut::Complex& complex, const std::vector<Atom>& atoms, double least_thickness_mm,
           Figures& figures)
        : atoms_(atoms),
          contacts_(contacts_of(atoms)),
          least_thickness_mm_(least_thickness_mm),
          figures_(figures) {
        for (const Atom& atom : atoms) {
            labels_.push_back(winner(atom.tally));
            volumes_.push_back(complex.volume_mm3(atom.region));
        }
        adopt_the_voteless();
    }

    std::vector<std::int32_t> run() {
        const double whole = std::accumulate(volumes_.begin(), volumes_.end(), 0.0);
        for (std::size_t round = 0; round < atoms_.size(); ++round) {
            const std::vector<Piece> all = pieces();
            const Piece* sick = smallest_sick(all);
            if (sick == nullptr) {
                break;
            }
            const auto into =
                std::max_element(sick->touching.begin(), sick->touching.end(),
                                 [](const auto& l, const auto& r) { return l.second < r.second; });
            for (const std::size_t atom : sick->atoms) {
                labels_[atom] = into->first;
            }
            ++figures_.healed;
            figures_.healed_share += sick->volume_mm3 / whole;
        }
        return std::move(labels_);
    }

  private:
    /// The label of the labelled atom that an atom touches most; -1 if there is none.
    [[nodiscard]] std::int32_t label_in_most_contact(std::size_t atom) const {
        double most = 0;
        std::int32_t label = -1;
        for (const auto& [other, area] : contacts_[atom]) {
            if (labels_[other] >= 0 && area > most) {
                most = area;
                label = labels_[other];
            }
        }
        return label;
    }

    void adopt_the_voteless() {
        for (bool changed = true; changed;) {
            changed = false;
            for (std::size_t i = 0; i < atoms_.size(); ++i) {
                const std::int32_t label = label_in_most_contact(i);
                if (labels_[i] < 0 && label >= 0) {
                    labels_[i] = label;
                    changed = true;
                }
            }
        }
        auto next = static_cast<std::int32_t>(atoms_.empty() ? 0 : atoms_[0].tally.size());
        for (std::int32_t& label : labels_) {
            label = label < 0 ? next++ : label;
        }
    }

    [[nodiscard]] std::vector<Piece> pieces() const {
        std::vector<Piece> out;
        std::vector<char> seen(atoms_.size(), 0);
        for (std::size_t start = 0; start < atoms_.size(); ++start) {
            if (seen[start] == 0) {
                out.push_back(piece_about(start, seen));
            }
        }
        return out;
    }

    [[nodiscard]] Piece piece_about(std::size_t start, std::vector<char>& seen) const {
        Piece piece;
        std::vector<std::size_t> open{start};
        seen[start] = 1;
        while (!open.empty()) {
            const std::size_t i = open.back();
            open.pop_back();
            piece.atoms.push_back(i);
            piece.volume_mm3 += volumes_[i];
            const auto label = static_cast<std::size_t>(labels_[i]);
            piece.votes_mm3 +=
                label < atoms_[i].tally.size() ? atoms_[i].tally[label] : volumes_[i];
            for (const auto& [other, area] : contacts_[i]) {
                if (labels_[other] != labels_[i]) {
                    piece.touching[labels_[other]] += area;
                    piece.interface_mm2 += area;
                } else if (seen[other] == 0) {
                    seen[other] = 1;
                    open.push_back(other);
                }
            }
        }
        return piece;
    }

    [[nodiscard]] const Piece* smallest_sick(const std::vector<Piece>& all) const {
        std::map<std::int32_t, const Piece*> best;
        for (const Piece& piece : all) {
            const Piece*& known = best[labels_[piece.atoms.front()]];
            known = known == nullptr || piece.votes_mm3 > known->votes_mm3 ? &piece : known;
        }
        const Piece* out = nullptr;
        for (const Piece& piece : all) {
            const bool stray = best[labels_[piece.atoms.front()]] != &piece;
            const bool thin = piece.volume_mm3 < least_thickness_mm_ * piece.interface_mm2;
            if ((stray || thin) && !piece.touching.empty() &&
                (out == nullptr || piece.volume_mm3 < out->volume_mm3)) {
                out = &piece;
            }
        }
        return out;
    }

    const std::vector<Atom>& atoms_;
    Areas contacts_;
    double least_thickness_mm_;
    Figures& figures_;
    std::vector<std::int32_t> labels_;
    std::vector<double> volumes_;
};

}  // namespace

std::vector<std::int32_t> healed_labels(const cut::Complex& complex, const std::vector<Atom>& atoms,
                                        double least_thickness_mm, Figures& figures) {
    return Healer(complex, atoms, least_thickness_mm, figures).run();
}

}  // namespace decomp::partition
