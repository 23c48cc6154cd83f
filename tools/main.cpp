// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/base/nearest.h"
#include "tools/console.h"
#include "tools/exit_code.h"
#include "tools/signals.h"
#include "tools/verb.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace {

using tools::Json;

/// One verb on the command line, ready to run after parsing.
struct Declared {
    const tools::Verb* verb;
    CLI::App* app;
    tools::Action action;
};

void add_common(CLI::App& app, tools::Common& common) {
    app.add_flag("--json", common.json, "one JSON object on stdout, logs on stderr")
        ->group("General");
    app.add_flag("-q,--quiet", common.quiet, "errors only")->group("General");
    app.add_flag("-v,--verbose", common.verbosity, "say more")->group("General");
    app.add_option("--jobs", common.jobs,
                   "threads at most; 0: one for each core. Results never depend on it")
        ->check(CLI::Range(0, 1024))
        ->group("General");
    app.add_option("--seed", common.seed, "of everything random")
        ->capture_default_str()
        ->group("General");
    app.set_help_flag("-h,--help", "this help")->group("General");
}

/// The long options of an app, with their dashes.
std::vector<std::string> option_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options()) {
        for (const std::string& name : option->get_lnames()) {
            names.push_back("--" + name);
        }
    }
    return names;
}

std::string with_hint(const std::string& message, const std::string& hint) {
    return hint.empty() ? message : message + "; " + hint;
}

/// A verb or a long option that does not exist, with what was probably meant. Looked for before
/// parsing, so that a misspelt option is not reported as the absence of a required one.
std::optional<std::string> misspelt(const std::vector<Declared>& declared, int argc, char** argv) {
    const std::vector<std::string> words(argv + 1, argv + argc);
    if (words.empty() || words[0].starts_with('-')) {
        return std::nullopt;
    }
    std::vector<std::string> names;
    for (const Declared& verb : declared) {
        names.emplace_back(verb.verb->name);
        if (words[0] != verb.verb->name) {
            continue;
        }
        const std::vector<std::string> known = option_names(*verb.app);
        for (std::size_t i = 1; i < words.size() && words[i] != "--"; ++i) {
            const std::string name = words[i].substr(0, words[i].find('='));
            if (name.starts_with("--") &&
                std::find(known.begin(), known.end(), name) == known.end()) {
                return with_hint("'" + words[0] + "' has no option '" + name + "'",
                                 decomp::did_you_mean(name, known));
            }
        }
        return std::nullopt;
    }
    return with_hint("there is no verb '" + words[0] + "'", decomp::did_you_mean(words[0], names));
}

Json error_json(const decomp::Error& error) {
    return {{"code", error.code},
            {"message", error.message},
            {"where", error.where},
            {"hint", error.hint},
            {"notes", error.notes}};
}

void print_json(const Json& json) {
    const std::string text = json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
    std::fwrite(text.data(), 1, text.size(), stdout);
}

/// Prints an error where its reader looks for it, and gives its exit code.
int report(const decomp::Error& error, const std::string& verb, bool json) {
    const int code = tools::exit_code(error);
    if (json) {
        print_json(
            {{"ok", false}, {"verb", verb}, {"exit_code", code}, {"error", error_json(error)}});
    }
    std::fprintf(stderr, "error: %s\n", error.text().c_str());
    return code;
}

int report_usage(const std::string& message, const std::string& verb, bool json) {
    const std::string help = verb.empty() ? "hew --help" : "hew " + verb + " --help";
    return report({"usage.command_line", message, {}, "see '" + help + "'", {}}, verb, json);
}

int answer(const decomp::Result<tools::Answer>& result, const std::string& verb,
           const tools::Common& common) {
    if (!result) {
        return report(result.error(), verb, common.json);
    }
    if (common.json) {
        Json json{{"ok", result->exit_code == tools::kOk},
                  {"verb", verb},
                  {"exit_code", result->exit_code}};
        json.update(result->json);
        print_json(json);
    } else if (!common.quiet) {
        std::fwrite(result->text.data(), 1, result->text.size(), stdout);
    }
    return std::fflush(stdout) == 0 ? result->exit_code : tools::kInputOutput;
}

int run_verb(const Declared& declared, const tools::Common& common) {
    tools::Console console(common);
    decomp::Run run;
    run.jobs = common.jobs > 0
                   ? common.jobs
                   : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    run.seed = common.seed;
    run.stop = tools::stop_on_signals().get_token();
    run.log_sink = [&](const decomp::LogEvent& event) { console.log(event); };
    run.progress_sink = [&](const decomp::Progress& progress) { console.progress(progress); };
    const auto result = declared.action(run);
    console.clear();
    return answer(result, declared.verb->name, common);
}

int run_command_line(int argc, char** argv) {
    CLI::App app{
        "Hew cuts a shape that is too big for a machine into parts, and writes a proved program "
        "for each."};
    app.name("hew");
    app.set_version_flag("--version", std::string("hew ") + HEW_VERSION);
    app.set_help_flag("-h,--help", "this help");
    app.require_subcommand(1);
    app.footer(
        "'hew VERB --help' explains a verb. Exit codes: 0 done, 2 command line, 3 bad input, 4 "
        "cannot be made,\n"
        "5 proof failed, 6 files, 7 machine or port, 130 interrupted.");
    tools::Common common;
    std::vector<Declared> declared;
    for (const tools::Verb& verb : tools::verbs()) {
        CLI::App* sub = app.add_subcommand(verb.name, verb.summary)->group(verb.group);
        declared.push_back({&verb, sub, verb.declare(*sub, common)});
        add_common(*sub, common);
        sub->footer(std::string("Examples:\n") + verb.examples);
    }
    // Wanted even where the command line cannot be understood.
    const bool json = std::any_of(argv + 1, argv + argc,
                                  [](const char* word) { return std::string("--json") == word; });
    if (argc < 2) {
        std::fputs(app.help().c_str(), stderr);
        return tools::kUsage;
    }
    if (const auto message = misspelt(declared, argc, argv)) {
        return report_usage(*message, {}, json);
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
            return app.exit(error);
        }
        return report_usage(error.what(), argv[1][0] == '-' ? "" : argv[1], json);
    }
    const auto chosen = std::find_if(declared.begin(), declared.end(),
                                     [](const Declared& verb) { return verb.app->parsed(); });
    return run_verb(*chosen, common);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run_command_line(argc, argv);
    } catch (const std::bad_alloc&) {
        std::fputs("error: out of memory [internal.memory]\n", stderr);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "error: %s [internal.exception]\n", error.what());
    }
    return tools::kInternal;
}
