// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/sim/grbl_board.h"
#include "cam/sim/log_replay.h"
#include "cam/sim/marlin_board.h"
#include "cam/sim/virtual_machine.h"
#include "decomp/base/file.h"
#include "tools/verb.h"

#include <algorithm>
#include <condition_variable>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <mutex>
#include <vector>

namespace tools {

namespace {

namespace fs = std::filesystem;
using decomp::fail;
using decomp::Result;

struct Command {
    std::string kind;
    std::string link;
    fs::path faults;
    fs::path log;
    fs::path executed;
    double seconds = 0;
    long baud = 0;
    cam::sim::BoardOptions board;
    bool no_emergency_parser = false;
    bool no_autoreport = false;
    std::vector<double> work_offset_mm;
};

Result<std::unique_ptr<cam::sim::Board>> board_of(const Command& command) {
    cam::sim::BoardOptions options = command.board;
    options.emergency_parser = !command.no_emergency_parser;
    options.autoreport = !command.no_autoreport;
    if (command.kind == "marlin") {
        return std::make_unique<cam::sim::MarlinBoard>(options);
    }
    if (command.kind == "grbl") {
        auto board = std::make_unique<cam::sim::GrblBoard>(options);
        cam::sim::Point offset{};
        std::copy(command.work_offset_mm.begin(), command.work_offset_mm.end(), offset.begin());
        board->set_work_offset(offset);
        return board;
    }
    const auto text = decomp::read_file(command.log);
    if (!text) {
        return fail(text.error());
    }
    auto replay = cam::sim::LogReplay::read(*text);
    if (!replay) {
        return fail("usage.sim", replay.error(), command.log.string());
    }
    return std::move(*replay);
}

/// Waits for the signal that ends it, or for as long as was asked.
void wait(const decomp::Run& run, double seconds) {
    std::mutex mutex;
    std::condition_variable_any woken;
    std::unique_lock lock(mutex);
    const auto never = [] { return false; };
    if (seconds > 0) {
        woken.wait_for(lock, run.stop, std::chrono::duration<double>(seconds), never);
    } else {
        woken.wait(lock, run.stop, never);
    }
}

Result<Answer> simulate(const Command& command, const decomp::Run& run) {
    cam::sim::VirtualMachine::Options options;
    options.baud = command.baud;
    options.link = command.link;
    if (!command.faults.empty()) {
        const auto script = decomp::read_file(command.faults);
        if (!script) {
            return fail(script.error());
        }
        const auto faults = cam::sim::read_faults(*script);
        if (!faults) {
            return fail("usage.sim", faults.error(), command.faults.string());
        }
        options.faults = *faults;
    }
    auto board = board_of(command);
    if (!board) {
        return fail(board.error());
    }
    long executed = 0;
    std::FILE* list =
        command.executed.empty() ? nullptr : std::fopen(command.executed.c_str(), "we");
    (*board)->on_executed = [&executed, list](std::string_view text) {
        ++executed;
        if (list != nullptr) {
            std::fprintf(list, "%.*s\n", static_cast<int>(text.size()), text.data());
        }
    };
    cam::sim::VirtualMachine machine(std::move(*board), options);
    if (const auto started = machine.start(); !started) {
        return fail("transport.refused", started.error(), "pseudo-terminal");
    }
    run.info("virtual " + command.kind + " at " + machine.port() + "; Ctrl-C ends it");
    wait(run, command.seconds);
    const std::string port = machine.port();
    std::size_t overflowed = 0;
    machine.visit([&](cam::sim::Board& one, cam::sim::Wire&, cam::sim::Time) {
        overflowed = one.overflowed();
    });
    machine.stop();
    if (list != nullptr) {
        std::fclose(list);
    }
    Answer answer;
    answer.json = {{"port", port}, {"executed", executed}, {"overflowed_bytes", overflowed}};
    answer.text = std::to_string(executed) + " commands carried out, " +
                  std::to_string(overflowed) + " bytes lost in a full buffer\n";
    return answer;
}

}  // namespace

Action declare_sim(CLI::App& app, const Common& /*common*/) {
    auto command = std::make_shared<Command>();
    app.add_option("kind", command->kind,
                   "marlin, grbl, or replay: the machine's side of a raw log")
        ->required()
        ->check(CLI::IsMember({"marlin", "grbl", "replay"}));
    app.add_option("--pty", command->link, "a name for its port: a link that this makes");
    app.add_option("--baud", command->baud, "bytes take their time at this rate; 0: none")
        ->check(CLI::Range(0L, 10000000L));
    app.add_option("--faults", command->faults, "script of faults; see docs/streaming.md");
    app.add_option("--log", command->log, "raw log to replay");
    app.add_option("--executed", command->executed, "writes every command that it carries out");
    app.add_option("--seconds", command->seconds, "ends after this time; 0: never");
    app.add_option("--speed", command->board.speed, "its time runs this many times faster")
        ->check(CLI::Range(0.01, 1000000.0));
    app.add_flag("--instant", command->board.instant, "motion and heating take no time");
    app.add_option("--axes", command->board.axes, "of grbl")->check(CLI::Range(3, 6));
    app.add_option("--work-offset", command->work_offset_mm,
                   "of grbl: where the part's zero lies in machine coordinates, X,Y,Z in mm")
        ->delimiter(',')
        ->expected(3);
    app.add_flag("--locked", command->board.homing, "grbl wants to be homed first");
    app.add_flag("--advanced-ok", command->board.advanced_ok,
                 "marlin tells line numbers with its answers");
    app.add_flag("--no-emergency-parser", command->no_emergency_parser,
                 "marlin sees a stop only behind what waits");
    app.add_flag("--no-autoreport", command->no_autoreport,
                 "marlin tells temperatures only when it is asked");
    return [command](const decomp::Run& run) { return simulate(*command, run); };
}

}  // namespace tools
