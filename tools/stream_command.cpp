// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/exit_code.h"
#include "tools/job_options.h"
#include "tools/stream_target.h"
#include "tools/stream_view.h"
#include "tools/values.h"

#include <memory>
#include <thread>

namespace tools {

namespace {

using cam::stream::ProgramStream;
using decomp::Result;
using decomp::Run;

struct Command {
    StreamTarget target;
    cam::stream::Request decisions;
    long from_line = 0;
    bool dry_run = false;
    bool yes = false;
    std::filesystem::path events;
};

Answer ended(const cam::stream::Outcome& outcome) {
    Answer answer;
    const bool finished = outcome.phase == cam::protocol::Phase::Finished;
    answer.exit_code = finished ? kOk : kCancelled;
    answer.json["phase"] = cam::protocol::phase_name(outcome.phase);
    answer.json["lines"] = {{"acked", outcome.progress.acked},
                            {"sent", outcome.progress.sent},
                            {"total", outcome.progress.total},
                            {"resent", outcome.progress.resent},
                            {"lost_answers", outcome.progress.lost_answers}};
    answer.json["seconds"] = outcome.seconds;
    answer.text = std::string(cam::protocol::phase_name(outcome.phase)) + ": " +
                  std::to_string(outcome.progress.acked) + " of " +
                  std::to_string(outcome.progress.total) + " lines in " +
                  duration_text(outcome.seconds) +
                  (outcome.text.empty() ? "" : "; " + outcome.text) + "\n";
    return answer;
}

Result<Answer> stream(const Command& command, const Common& common, const Run& run) {
    auto request = stream_request(command.target);
    if (!request) {
        return decomp::fail(request.error());
    }
    request->foreign = command.decisions.foreign;
    request->allowed = command.decisions.allowed;
    request->resume = command.decisions.resume;
    request->after_reset = command.decisions.after_reset;
    request->force = command.decisions.force;
    request->looks = !command.dry_run;
    request->journal = command.decisions.journal;
    request->log = command.decisions.log;
    if (command.from_line > 0) {
        request->from_line = command.from_line;
    }
    if (command.yes) {
        request->notes.emplace_back("--yes");
    }
    const std::string port = request->port;
    auto opened = ProgramStream::open(std::move(*request));
    if (!opened) {
        return decomp::fail(opened.error());
    }
    ProgramStream& program = **opened;
    if (command.dry_run) {
        Answer answer;
        answer.text = program.summary();
        answer.json["summary"] = program.summary();
        answer.json["lines"] = program.job().lines.size();
        return answer;
    }
    run.info(program.summary() + "port " + port);
    StreamView view(program, {command.yes, common.quiet, common.json, command.events});
    Result<cam::stream::Outcome> outcome = cam::stream::Outcome{};
    std::thread carrier([&] {
        outcome = program.run([&](const cam::stream::Notice& notice) { view.tell(notice); });
        view.end();
    });
    view.watch(run.stop);
    carrier.join();
    if (!outcome) {
        return decomp::fail(outcome.error());
    }
    if (outcome->phase == cam::protocol::Phase::Failed) {
        return decomp::fail(
            outcome->code,
            outcome->text + " (" + std::to_string(outcome->progress.acked) + " of " +
                std::to_string(outcome->progress.total) + " lines answered for)",
            port,
            outcome->progress.sent > 0 ? "mend the cause, then 'hew stream … --resume'"
                                       : "nothing was sent");
    }
    return ended(*outcome);
}

}  // namespace

Action declare_stream(CLI::App& app, const Common& common) {
    auto command = std::make_shared<Command>();
    StreamTarget& target = command->target;
    app.add_option("job", target.job, "job directory, or a program with its proof beside it")
        ->required();
    app.add_option("--plate", target.plate, "plate of a job that has several, e.g. plate-2");
    app.add_option("--port", target.port,
                   "serial device, pseudo-terminal, tcp:HOST:PORT, or auto: the one that fits")
        ->default_val("auto");
    app.add_option("--link", target.link, "how it is connected: another file of links/");
    add_machine_options(app, target.machine, target.material, target.settings, false);
    app.add_flag("--foreign", command->decisions.foreign,
                 "a program without proof: only its bounds are looked at");
    app.add_option("--allow", command->decisions.allowed,
                   "lets an objection pass; written into the journal; may be repeated")
        ->check(CLI::IsMember(cam::stream::known_allowances()))
        ->allow_extra_args(false);
    app.add_flag("--resume", command->decisions.resume, "go on where the journal says");
    app.add_flag("--after-reset", command->decisions.after_reset,
                 "with --resume: the machine was reset, and is homed and idle again");
    app.add_option("--from-line", command->from_line,
                   "with --resume: go on from this line of the program")
        ->check(CLI::PositiveNumber);
    app.add_flag("--dry-run", command->dry_run, "judge the program, send nothing");
    app.add_flag("--yes", command->yes, "answer every question with yes; written into the journal");
    app.add_flag("--force", command->decisions.force,
                 "begin anew: an older journal is thrown away");
    app.add_option("--journal", command->decisions.journal, "where; else PROGRAM.journal");
    app.add_option("--log", command->decisions.log, "raw log of the wire, with times");
    app.add_option("--events", command->events, "what happens, one JSON object a line");
    return [command, &common](const Run& run) { return stream(*command, common, run); };
}

}  // namespace tools
