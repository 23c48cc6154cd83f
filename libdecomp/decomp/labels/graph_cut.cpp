// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/labels/graph_cut.h"

#include <CGAL/boost/graph/Alpha_expansion_MaxFlow_tag.h>
#include <CGAL/property_map.h>

#include <limits>
#include <utility>

namespace decomp::labels {

namespace {

constexpr std::uint32_t kFrozen = std::numeric_limits<std::uint32_t>::max();
constexpr double kForbidden = 1e30;       // more than any sum of costs
constexpr double kLeastDecrease = 1e-10;  // of the energy: less is rounding

/// The active facets as a graph; what touches a frozen facet became a cost.
struct CutGraph {
    std::vector<LabelCosts> costs;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    std::vector<double> weights;
    std::vector<std::uint8_t> labels;
};

/// A frozen neighbour makes every label but its own dearer.
void add_frozen_step(LabelCosts& cost, AxisLabel frozen, double step) {
    for (std::size_t l = 0; l < kLabelCount; ++l) {
        cost.at(l) += l == static_cast<std::size_t>(frozen) ? 0 : step;
    }
}

CutGraph graph_of(const Energy& energy, std::span<const LabelCosts> extra,
                  std::span<const std::uint32_t> active, const Labeling& labels) {
    const Facets& facets = energy.facets();
    std::vector<std::uint32_t> slot(facets.count(), kFrozen);
    for (std::uint32_t i = 0; i < active.size(); ++i) {
        slot[active[i]] = i;
    }
    CutGraph graph;
    graph.costs.reserve(active.size());
    graph.labels.reserve(active.size());
    for (const auto f : active) {
        LabelCosts cost = energy.misfit(f);
        for (std::size_t l = 0; l < kLabelCount; ++l) {
            cost.at(l) += extra[f].at(l);
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t g = facets.neighbours[f].at(k);
            if (slot[g] == kFrozen) {
                add_frozen_step(cost, labels[g], energy.step(f, k));
            } else if (f < g) {
                graph.edges.emplace_back(slot[f], slot[g]);
                graph.weights.push_back(energy.step(f, k));
            }
        }
        graph.costs.push_back(cost);
        graph.labels.push_back(static_cast<std::uint8_t>(labels[f]));
    }
    return graph;
}

double total(const CutGraph& graph) {
    double sum = 0;
    for (std::size_t i = 0; i < graph.costs.size(); ++i) {
        sum += graph.costs[i].at(graph.labels[i]);
    }
    for (std::size_t e = 0; e < graph.edges.size(); ++e) {
        const auto [a, b] = graph.edges[e];
        sum += graph.labels[a] != graph.labels[b] ? graph.weights[e] : 0;
    }
    return sum;
}

/// Lets every vertex choose between its label and alpha, at least cost in total. A fresh flow graph
/// each time: clearing CGAL's does not set its flow back to zero, and its own loop over the labels
/// therefore stops after the first one (CGAL 5.5).
std::vector<std::uint8_t> expanded(const CutGraph& graph, std::uint8_t alpha) {
    CGAL::Alpha_expansion_MaxFlow_impl flow;
    using Node = CGAL::Alpha_expansion_MaxFlow_impl::Vertex_descriptor;
    std::vector<Node> nodes;
    nodes.reserve(graph.costs.size());
    for (std::size_t i = 0; i < graph.costs.size(); ++i) {
        Node node = flow.add_vertex();
        const double stay =
            graph.labels[i] == alpha ? kForbidden : graph.costs[i].at(graph.labels[i]);
        flow.add_tweight(node, graph.costs[i].at(alpha), stay);
        nodes.push_back(node);
    }
    for (std::size_t e = 0; e < graph.edges.size(); ++e) {
        const auto [a, b] = graph.edges[e];
        const double weight = graph.weights[e];
        if (graph.labels[a] == graph.labels[b]) {
            if (graph.labels[a] != alpha) {
                flow.add_edge(nodes[a], nodes[b], weight, weight);
            }
            continue;
        }
        Node between = flow.add_vertex();
        const double to_a = graph.labels[a] == alpha ? 0 : weight;
        const double to_b = graph.labels[b] == alpha ? 0 : weight;
        flow.add_edge(between, nodes[a], to_a, to_a);
        flow.add_edge(between, nodes[b], to_b, to_b);
        flow.add_tweight(between, 0, weight);
    }
    flow.init_vertices();
    flow.max_flow();
    std::vector<std::uint8_t> labels = graph.labels;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        flow.update(CGAL::make_property_map(labels), nodes, i, i, alpha);
    }
    return labels;
}

}  // namespace

void lower(const Energy& energy, std::span<const LabelCosts> extra,
           std::span<const std::uint32_t> active, Labeling& labels) {
    if (active.empty()) {
        return;
    }
    CutGraph graph = graph_of(energy, extra, active, labels);
    double least = total(graph);
    int unchanged = 0;  // labels in a row that gained nothing
    for (std::uint8_t alpha = 0; unchanged < kLabelCount;
         alpha = static_cast<std::uint8_t>((alpha + 1) % kLabelCount)) {
        std::vector<std::uint8_t> before = graph.labels;
        graph.labels = expanded(graph, alpha);
        const double now = total(graph);
        if (now < least - kLeastDecrease * least) {
            least = now;
            unchanged = 1;  // it gains nothing more right away
        } else {
            graph.labels = std::move(before);
            ++unchanged;
        }
    }
    for (std::size_t i = 0; i < active.size(); ++i) {
        labels[active[i]] = static_cast<AxisLabel>(graph.labels[i]);
    }
}

}  // namespace decomp::labels
