// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/sim/grbl_board.h"
#include "cam/sim/log_replay.h"
#include "cam/sim/marlin_board.h"
#include "cam/sim/modbus_server.h"
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
    std::string tcp;  ///< HOST:PORT of modbus; empty: a pseudo-terminal
    int unit = 1;
    double scan_ms = 10;
    cam::sim::PlcOptions plc;
    bool no_function_23 = false;
};

/// Writes down what a machine carries out.
struct ExecutedList {
    long count = 0;
    std::FILE* file = nullptr;

    explicit ExecutedList(const fs::path& path)
        : file(path.empty() ? nullptr : std::fopen(path.c_str(), "we")) {}

    ExecutedList(const ExecutedList&) = delete;
    ExecutedList& operator=(const ExecutedList&) = delete;
    ExecutedList(ExecutedList&&) = delete;
    ExecutedList& operator=(ExecutedList&&) = delete;

    ~ExecutedList() {
        if (file != nullptr) {
            std::fclose(file);
        }
    }

    void take(std::string_view text) {
        ++count;
        if (file != nullptr) {
            std::fprintf(file, "%.*s\n", static_cast<int>(text.size()), text.data());
        }
    }
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

Result<cam::sim::ModbusServer::Options> server_options(const Command& command) {
    cam::sim::ModbusServer::Options options;
    options.link = command.link;
    options.unit = command.unit;
    options.baud = command.baud;
    if (!command.tcp.empty()) {
        const std::size_t colon = command.tcp.find(':');
        const std::string port =
            colon == std::string::npos ? command.tcp : command.tcp.substr(colon + 1);
        if (port.empty() || port.size() > 5 ||
            port.find_first_not_of("0123456789") != std::string::npos || std::stoi(port) > 65535) {
            return fail("usage.sim", "--tcp takes HOST:PORT or PORT", command.tcp,
                        "--tcp 127.0.0.1:5020");
        }
        if (colon != std::string::npos) {
            options.host = command.tcp.substr(0, colon);
        }
        options.port = std::stoi(port);
    }
    if (!command.faults.empty()) {
        const auto script = decomp::read_file(command.faults);
        if (!script) {
            return fail(script.error());
        }
        const auto faults = cam::sim::read_modbus_faults(*script);
        if (!faults) {
            return fail("usage.sim", faults.error(), command.faults.string());
        }
        options.faults = *faults;
    }
    return options;
}

Result<Answer> simulate_modbus(const Command& command, const decomp::Run& run) {
    const auto options = server_options(command);
    if (!options) {
        return fail(options.error());
    }
    cam::sim::PlcOptions plc = command.plc;
    plc.board = command.board;
    plc.scan = cam::sim::Time(static_cast<cam::sim::Time::rep>(command.scan_ms * 1e6));
    plc.combined = !command.no_function_23;
    ExecutedList list(command.executed);
    cam::sim::ModbusServer server(plc, *options);
    server.visit([&](cam::sim::Plc& one, cam::sim::Time) {
        one.on_executed = [&list](std::string_view text) { list.take(text); };
    });
    if (const auto started = server.start(); !started) {
        return fail("transport.refused", started.error(),
                    command.tcp.empty() ? "pseudo-terminal" : command.tcp);
    }
    run.info("virtual PLC at " + server.port() + ", unit " + std::to_string(command.unit) +
             "; Ctrl-C ends it");
    if (!command.tcp.empty() && !options->host.starts_with("127.")) {
        run.info("others in the network can reach it");
    }
    wait(run, command.seconds);
    server.stop();
    Answer answer;
    server.visit([&](cam::sim::Plc& one, cam::sim::Time now) {
        answer.json = {{"port", server.port()},
                       {"executed", list.count},
                       {"accepted", one.accepted()},
                       {"requests", server.requests()},
                       {"position", one.position(now)}};
    });
    answer.text = std::to_string(list.count) + " lines carried out in " +
                  std::to_string(server.requests()) + " requests\n";
    return answer;
}

Result<Answer> simulate(const Command& command, const decomp::Run& run) {
    if (command.kind == "modbus") {
        return simulate_modbus(command, run);
    }
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
    ExecutedList list(command.executed);
    (*board)->on_executed = [&list](std::string_view text) { list.take(text); };
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
    Answer answer;
    answer.json = {{"port", port}, {"executed", list.count}, {"overflowed_bytes", overflowed}};
    answer.text = std::to_string(list.count) + " commands carried out, " +
                  std::to_string(overflowed) + " bytes lost in a full buffer\n";
    return answer;
}

}  // namespace

Action declare_sim(CLI::App& app, const Common& /*common*/) {
    auto command = std::make_shared<Command>();
    app.add_option("kind", command->kind,
                   "marlin, grbl, modbus: a PLC, or replay: the machine's side of a raw log")
        ->required()
        ->check(CLI::IsMember({"marlin", "grbl", "modbus", "replay"}));
    app.add_option("--pty", command->link, "a name for its port: a link that this makes");
    app.add_option("--baud", command->baud, "bytes take their time at this rate; 0: none")
        ->check(CLI::Range(0L, 10000000L));
    app.add_option("--tcp", command->tcp,
                   "of modbus: serves HOST:PORT (HOST: 127.0.0.1 unless given) instead of a "
                   "pseudo-terminal");
    app.add_option("--unit", command->unit, "of modbus: its number")->check(CLI::Range(1, 247));
    app.add_option("--scan", command->scan_ms, "of modbus: time of a scan, ms; 0: one a request")
        ->check(CLI::Range(0.0, 10000.0));
    app.add_option("--queue", command->plc.queue_lines, "of modbus: lines of its queue")
        ->check(CLI::Range(1, 65535));
    app.add_flag("--retentive", command->plc.retentive,
                 "of modbus: its counters survive a restart");
    app.add_flag("--no-function-23", command->no_function_23, "of modbus: it knows 3, 4 and 16");
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
