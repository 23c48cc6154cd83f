// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/partition/cuts.h"

#include "decomp/partition/outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

namespace decomp::partition {

namespace {

constexpr double kWrongWeight = 3;    // votes put wrong count this much against those put right
constexpr double kStrayFactor = 0.7;  // on the gain of a plane with no sheet between the two boxes
constexpr double kWindow = 0.3;       // of the best gain: candidates that thickness ranks
constexpr double kMostOfBox = 0.5;    // a region with more of a box than this should be cut for it
constexpr int kMostCuts = 400;
constexpr double kAsMuch = 1 - 1e-9;  // of a gain: sums that differ by rounding alone are equal
/// Of the diagonal: where a plane would take off a tongue, one beside it may take off a lip alone.
constexpr std::array<double, 10> kShifts{0.005,  -0.005, 0.01,  -0.01, 0.015,
                                         -0.015, 0.02,   -0.02, 0.03,  -0.03};
constexpr double kNone = -1e300;

/// What a cut along some bodies' borders would do to the votes of a region.
struct Gain {
    double right = 0;  ///< votes of new winners where the winner changes
    double wrong = 0;  ///< votes of the old winner there

    [[nodiscard]] double net() const { return right - kWrongWeight * wrong; }
};

Gain gain_of(const std::vector<Tally>& sides, std::int32_t present) {
    Gain out;
    for (const Tally& side : sides) {
        const std::int32_t best = winner(side);
        if (best >= 0 && best != present) {
            out.right += side[static_cast<std::size_t>(best)];
            out.wrong += side[static_cast<std::size_t>(present)];
        }
    }
    return out;
}

double entropy(const Tally& tally) {
    const double sum = std::accumulate(tally.begin(), tally.end(), 0.0);
    double out = 0;
    for (const double x : tally) {
        out += x > 0 ? x * std::log(sum / x) : 0;
    }
    return out;
}

/// A cut that could be made.
struct Choice {
    std::size_t atom = 0;
    std::int32_t plane = -1;
    double rank = kNone;  ///< gain, less where the plane is a stray
    double thickness_mm = 0;
    bool limited = false;
    std::vector<std::int32_t> pieces;  ///< of the section, when limited
    double shift_mm = 0;               ///< of the plane along its normal
};

/// What is known of one plane in one region; stays true until the region is cut.
struct Look {
    std::optional<Choice> whole;
    std::optional<Choice> limited;
    double entropy_gain = 0;
    bool thin = false;
    bool useless = false;  ///< it was tried and divides nothing
};

/// The bodies that the whole plane would make of a region, and the pieces between them.
struct Bodies {
    std::vector<cut::SectionPiece> pieces;
    std::vector<Tally> tallies;
};

class Cutter {
  public:
    Cutter(cut::Complex& complex, const Ballot& ballot, sheets::Sheets& sheets,
           const PartitionOptions& options, Figures& figures)
        : complex_(complex),
          ballot_(ballot),
          sheets_(sheets),
          options_(options),
          figures_(figures),
          nudged_(sheets.planes.size(), 0) {}

    Result<std::vector<Atom>> run(const Run& run) {
        std::vector<std::int32_t> regions(static_cast<std::size_t>(complex_.region_count()));
        std::iota(regions.begin(), regions.end(), 0);
        atoms_ = ballot_.placed(complex_, regions);
        double placed = 0;
        for (const Atom& atom : atoms_) {
            placed += std::accumulate(atom.tally.begin(), atom.tally.end(), 0.0);
        }
        figures_.lost_share = 1 - placed / ballot_.total_mm3();
        looks_.resize(atoms_.size());
        for (int cuts = 0; cuts < kMostCuts; ++cuts) {
            if (run.cancelled()) {
                return cancelled();
            }
            Result<std::optional<Choice>> choice = best();
            if (!choice) {
                return fail(choice.error());
            }
            if (!*choice) {
                break;
            }
            if (Status made = make(**choice); !made) {
                return fail(made.error());
            }
        }
        for (const std::vector<Look>& looks : looks_) {
            for (const Look& look : looks) {
                figures_.skipped_tongues += look.thin ? 1 : 0;
            }
        }
        // A later cut divides what an atom had as its neighbour.
        for (Atom& atom : atoms_) {
            atom.part = complex_.region(atom.region);
        }
        return std::move(atoms_);
    }

  private:
    [[nodiscard]] double least_gain() const {
        return options_.least_gain_share * ballot_.total_mm3();
    }

    [[nodiscard]] double least_thickness() const {
        return options_.least_thickness_share * sheets_.diagonal_mm;
    }

    [[nodiscard]] const part::Plane& plane(std::int32_t index) const {
        return sheets_.planes[static_cast<std::size_t>(index)].plane;
    }

    /// The votes of an atom below and above a plane.
    [[nodiscard]] std::vector<Tally> sides_of(const Atom& atom, const part::Plane& cut) const {
        std::vector<Tally> out(2, Tally(atom.tally.size(), 0));
        for (const std::uint32_t index : atom.votes) {
            const Vote& vote = ballot_.votes()[index];
            out[cut.normal.dot(vote.point) < cut.offset_mm ? 0 : 1]
               [static_cast<std::size_t>(vote.box)] += vote.weight_mm3;
        }
        return out;
    }

    /// Whether some sheet of the plane lies between these two boxes.
    [[nodiscard]] bool parts(std::int32_t index, std::int32_t below, std::int32_t above) const {
        return std::any_of(
            sheets_.sheets.begin(), sheets_.sheets.end(), [&](const sheets::Sheet& sheet) {
                return sheet.plane == index &&
                       std::binary_search(sheet.lower.begin(), sheet.lower.end(), below) &&
                       std::binary_search(sheet.upper.begin(), sheet.upper.end(), above);
            });
    }

    /// Looks at a plane in an atom.
    Result<Look> look_at(std::size_t index, std::int32_t cut) {
        const Atom& atom = atoms_[index];
        Look out;
        const std::int32_t present = winner(atom.tally);
        const double others = std::accumulate(atom.tally.begin(), atom.tally.end(), 0.0) -
                              (present < 0 ? 0 : atom.tally[static_cast<std::size_t>(present)]);
        if (present < 0 || others < least_gain()) {
            return out;
        }
        const std::vector<Tally> sides = sides_of(atom, plane(cut));
        const Gain gain = gain_of(sides, present);
        out.entropy_gain = entropy(atom.tally) - entropy(sides[0]) - entropy(sides[1]);
        const double factor = parts(cut, winner(sides[0]), winner(sides[1])) ? 1 : kStrayFactor;
        const bool might_gain = factor * gain.net() > least_gain();
        if (!might_gain && (!options_.limit_cuts || out.entropy_gain <= 0)) {
            return out;
        }
        const Outline outline = outline_of(atom.part.mesh, plane(cut));
        if (might_gain && outline.area_mm2 > 0) {
            const Choice choice{
                index, cut, factor * gain.net(), gain.net() / outline.area_mm2, false, {}, 0};
            if (choice.thickness_mm >= least_thickness()) {
                out.whole = choice;
            } else {
                out.whole = shifted_choice(index, cut, factor);
                out.thin = !out.whole;
            }
        }
        if (options_.limit_cuts && outline.curves > 1) {
            Result<std::optional<Choice>> limited = limited_choice(index, cut, factor);
            if (!limited) {
                return fail(limited.error());
            }
            if (*limited) {
                out.limited = **limited;
                out.thin = false;
            }
        }
        return out;
    }

    /// The nearest plane beside this one that gains thickly enough.
    [[nodiscard]] std::optional<Choice> shifted_choice(std::size_t index, std::int32_t cut,
                                                       double factor) const {
        const Atom& atom = atoms_[index];
        for (const double share : kShifts) {
            if (!options_.limit_cuts) {
                break;
            }
            part::Plane beside = plane(cut);
            beside.offset_mm += share * sheets_.diagonal_mm;
            const Gain gain = gain_of(sides_of(atom, beside), winner(atom.tally));
            if (factor * gain.net() <= least_gain()) {
                continue;
            }
            const double area = outline_of(atom.part.mesh, beside).area_mm2;
            if (area > 0 && gain.net() >= least_thickness() * area) {
                return Choice{index, cut, factor * gain.net(),        gain.net() / area,
                              false, {},  share * sheets_.diagonal_mm};
            }
        }
        return std::nullopt;
    }

    /// The bodies on either side of a plane, from a split of a copy.
    Result<std::optional<Bodies>> bodies_at(const Atom& atom, std::int32_t cut) {
        const part::Plane cut_plane = nudged(atom.region, cut);
        const auto pieces = complex_.section(atom.region, cut_plane);
        if (!pieces) {
            return fail(pieces.error());
        }
        if (pieces->size() < 2) {
            return std::optional<Bodies>{};
        }
        cut::Complex trial = complex_;
        const auto ids = trial.split(atom.region, cut_plane);
        if (!ids) {
            return fail(ids.error());
        }
        Bodies out{*pieces, {}};
        for (Atom& body : ballot_.placed(trial, *ids, atom.votes, nullptr)) {
            out.tallies.push_back(std::move(body.tally));
        }
        return std::optional<Bodies>(std::move(out));
    }

    /// The pieces of the section that gain by being cut, and thickly enough; nothing if those are
    /// all of them, or none.
    Result<std::optional<Choice>> limited_choice(std::size_t index, std::int32_t cut,
                                                 double factor) {
        const Atom& atom = atoms_[index];
        const auto bodies = bodies_at(atom, cut);
        if (!bodies) {
            return fail(bodies.error());
        }
        if (!*bodies) {
            return std::optional<Choice>{};
        }
        const std::vector<cut::SectionPiece>& pieces = (*bodies)->pieces;
        const std::int32_t present = winner(atom.tally);
        std::vector<char> wanted(pieces.size(), 1);
        const auto gain_with = [&](const std::vector<char>& chosen) {
            return gain_of(groups(**bodies, chosen), present).net();
        };
        for (bool dropped = true; dropped;) {
            dropped = false;
            const double whole = gain_with(wanted);
            std::size_t worst = pieces.size();
            double worst_thickness = 0;
            for (std::size_t i = 0; i < pieces.size(); ++i) {
                if (wanted[i] == 0) {
                    continue;
                }
                std::vector<char> without = wanted;
                without[i] = 0;
                const double loss = whole - gain_with(without);
                const double thickness = loss / pieces[i].area_mm2;
                if ((loss < least_gain() || thickness < least_thickness()) &&
                    (worst == pieces.size() || thickness < worst_thickness)) {
                    worst = i;
                    worst_thickness = thickness;
                }
            }
            if (worst < pieces.size()) {
                wanted[worst] = 0;
                dropped = true;
            }
        }
        Choice out{index, cut, factor * gain_with(wanted), 0, true, {}, 0};
        double area = 0;
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            if (wanted[i] != 0) {
                out.pieces.push_back(static_cast<std::int32_t>(i));
                area += pieces[i].area_mm2;
            }
        }
        if (out.pieces.empty() || out.pieces.size() == pieces.size() || out.rank < least_gain()) {
            return std::optional<Choice>{};
        }
        out.thickness_mm = out.rank / factor / area;
        return std::optional<Choice>(std::move(out));
    }

    /// The votes of what stays together when only the chosen pieces are cut.
    static std::vector<Tally> groups(const Bodies& bodies, const std::vector<char>& chosen) {
        std::vector<std::size_t> group(bodies.tallies.size());
        std::iota(group.begin(), group.end(), 0U);
        for (std::size_t i = 0; i < bodies.pieces.size(); ++i) {
            if (chosen[i] == 0) {
                const std::size_t from = group[static_cast<std::size_t>(bodies.pieces[i].above)];
                const std::size_t into = group[static_cast<std::size_t>(bodies.pieces[i].below)];
                std::replace(group.begin(), group.end(), from, into);
            }
        }
        std::map<std::size_t, Tally> sums;
        for (std::size_t i = 0; i < group.size(); ++i) {
            Tally& sum = sums.try_emplace(group[i], bodies.tallies[i].size(), 0.0).first->second;
            for (std::size_t box = 0; box < sum.size(); ++box) {
                sum[box] += bodies.tallies[i][box];
            }
        }
        std::vector<Tally> out;
        out.reserve(sums.size());
        for (auto& [body, sum] : sums) {
            out.push_back(std::move(sum));
        }
        return out;
    }

    /// The plane as it will cut: nudged once, for all regions.
    part::Plane nudged(std::int32_t region, std::int32_t cut) {
        part::Plane& own = sheets_.planes[static_cast<std::size_t>(cut)].plane;
        if (nudged_[static_cast<std::size_t>(cut)] != 0) {
            return own;
        }
        return complex_.nudged_off_vertices(region, own,
                                            options_.nudge_share * sheets_.diagonal_mm);
    }

    /// A plane shifted for one region alone.
    [[nodiscard]] part::Plane beside(std::int32_t region, const Choice& choice) const {
        part::Plane shifted = plane(choice.plane);
        shifted.offset_mm += choice.shift_mm;
        return complex_.nudged_off_vertices(region, shifted,
                                            options_.nudge_share * sheets_.diagonal_mm);
    }

    /// Looks at every plane for a region that has not been looked at.
    Status look_at_all(std::size_t index) {
        if (!looks_[index].empty()) {
            return {};
        }
        for (std::int32_t cut = 0; cut < static_cast<std::int32_t>(sheets_.planes.size()); ++cut) {
            Result<Look> look = look_at(index, cut);
            if (!look) {
                return fail(look.error());
            }
            looks_[index].push_back(std::move(*look));
        }
        return {};
    }

    Result<std::optional<Choice>> best() {
        std::vector<Choice> open;
        for (std::size_t i = 0; i < atoms_.size(); ++i) {
            if (Status looked = look_at_all(i); !looked) {
                return fail(looked.error());
            }
            for (const Look& look : looks_[i]) {
                // A limited cut is preferred where it gains nearly as much.
                if (look.useless) {
                    continue;
                }
                if (look.limited &&
                    (!look.whole || look.limited->rank >= kAsMuch * look.whole->rank)) {
                    open.push_back(*look.limited);
                } else if (look.whole) {
                    open.push_back(*look.whole);
                }
            }
        }
        if (open.empty()) {
            return last_resort();
        }
        const double most =
            std::max_element(open.begin(), open.end(), [](const Choice& l, const Choice& r) {
                return l.rank < r.rank;
            })->rank;
        // The thickest; of equally thick ones one that is limited, for it cuts less.
        const auto better = [](const Choice& choice, const Choice& than) {
            return kAsMuch * choice.thickness_mm > than.thickness_mm ||
                   (choice.limited && !than.limited &&
                    choice.thickness_mm >= kAsMuch * than.thickness_mm);
        };
        const Choice* chosen = nullptr;
        for (const Choice& choice : open) {
            if (choice.rank >= kWindow * most && (chosen == nullptr || better(choice, *chosen))) {
                chosen = &choice;
            }
        }
        return std::optional<Choice>(*chosen);
    }

    /// Where a region holds most of a box that it does not stand for, the plane that sorts its
    /// votes best.
    std::optional<Choice> last_resort() {
        std::optional<Choice> out;
        double best_gain = least_gain();
        for (std::size_t i = 0; i < atoms_.size(); ++i) {
            const Tally& tally = atoms_[i].tally;
            const std::int32_t present = winner(tally);
            bool misses = false;
            for (std::size_t box = 0; box < tally.size(); ++box) {
                misses = misses || (static_cast<std::int32_t>(box) != present &&
                                    tally[box] > kMostOfBox * ballot_.of_boxes()[box]);
            }
            for (std::size_t cut = 0; misses && cut < looks_[i].size(); ++cut) {
                const Look& look = looks_[i][cut];
                if (!look.useless && !look.thin && look.entropy_gain > best_gain) {
                    best_gain = look.entropy_gain;
                    out = Choice{i, static_cast<std::int32_t>(cut), best_gain, 0, false, {}, 0};
                }
            }
        }
        return out;
    }

    Status make(const Choice& choice) {
        const std::int32_t region = atoms_[choice.atom].region;
        const part::Plane cut =
            choice.shift_mm != 0 ? beside(region, choice) : nudged(region, choice.plane);
        Result<std::vector<std::int32_t>> ids = choice.limited
                                                    ? complex_.split(region, cut, choice.pieces)
                                                    : complex_.split(region, cut);
        Look& look = looks_[choice.atom][static_cast<std::size_t>(choice.plane)];
        if (!ids && choice.limited && ids.error().code == "cut.no_such_piece") {
            look.limited.reset();  // a piece in a face of the input: only the whole plane will do
            look.useless = !look.whole;
            return {};
        }
        if (!ids) {
            return fail(ids.error());
        }
        if (ids->size() < 2) {
            look.useless = true;
            return {};
        }
        if (choice.shift_mm == 0) {
            sheets_.planes[static_cast<std::size_t>(choice.plane)].plane = cut;
            nudged_[static_cast<std::size_t>(choice.plane)] = 1;
        }
        ++figures_.cuts;
        figures_.shifted_cuts += choice.shift_mm != 0 ? 1 : 0;
        figures_.limited_cuts += choice.limited ? 1 : 0;
        const std::vector<std::uint32_t> votes = atoms_[choice.atom].votes;
        std::vector<Atom> pieces =
            ballot_.placed(complex_, *ids, votes, choice.limited ? nullptr : &cut);
        atoms_[choice.atom] = std::move(pieces[0]);
        looks_[choice.atom].clear();
        for (std::size_t i = 1; i < pieces.size(); ++i) {
            atoms_.push_back(std::move(pieces[i]));
            looks_.emplace_back();
        }
        return {};
    }

    cut::Complex& complex_;
    const Ballot& ballot_;
    sheets::Sheets& sheets_;
    const PartitionOptions& options_;
    Figures& figures_;
    std::vector<char> nudged_;
    std::vector<Atom> atoms_;
    std::vector<std::vector<Look>> looks_;  // of each atom: one for each plane, or none yet
};

}  // namespace

Result<std::vector<Atom>> cut_by_votes(cut::Complex& complex, const Ballot& ballot,
                                       sheets::Sheets& sheets, const PartitionOptions& options,
                                       Figures& figures, const Run& run) {
    return Cutter(complex, ballot, sheets, options, figures).run(run);
}

}  // namespace decomp::partition
