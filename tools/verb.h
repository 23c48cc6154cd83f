// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"
#include "decomp/base/run.h"

#include <CLI/App.hpp>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <functional>
#include <span>
#include <string>

/// The command line `hew`: every verb parses, calls one door of a library and prints; nothing else.
namespace tools {

using Json = nlohmann::ordered_json;

/// Options that every verb has.
struct Common {
    bool json = false;
    bool quiet = false;
    int verbosity = 0;
    int jobs = 0;  ///< 0: as many as the machine has cores
    std::uint64_t seed = 1;
};

/// What a verb has to say on stdout: one object with --json, text without.
struct Answer {
    Json json = Json::object();
    std::string text;
    int exit_code = 0;
};

using Action = std::function<decomp::Result<Answer>(const decomp::Run&)>;

/// A verb as one row of the table that drives parsing, help and docs/cli.md.
struct Verb {
    const char* name;
    const char* group;
    const char* summary;
    const char* examples;
    Action (*declare)(CLI::App& app,
                      const Common& common);  ///< adds the options; the action runs after parsing
};

/// All verbs, in the order of the help.
[[nodiscard]] std::span<const Verb> verbs();

Action declare_make(CLI::App& app, const Common& common);
Action declare_decompose(CLI::App& app, const Common& common);
Action declare_export(CLI::App& app, const Common& common);
Action declare_mill(CLI::App& app, const Common& common);
Action declare_slice(CLI::App& app, const Common& common);
Action declare_verify(CLI::App& app, const Common& common);
Action declare_inspect(CLI::App& app, const Common& common);
Action declare_check(CLI::App& app, const Common& common);
Action declare_machines(CLI::App& app, const Common& common);
Action declare_render(CLI::App& app, const Common& common);
Action declare_polycube(CLI::App& app, const Common& common);
Action declare_stream(CLI::App& app, const Common& common);
Action declare_ports(CLI::App& app, const Common& common);
Action declare_sim(CLI::App& app, const Common& common);
Action declare_demo(CLI::App& app, const Common& common);

}  // namespace tools
