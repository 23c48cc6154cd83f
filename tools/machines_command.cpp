// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/profile/read_mill.h"
#include "cam/profile/read_profile.h"
#include "tools/verb.h"

#include <algorithm>
#include <memory>

namespace tools {

namespace {

void add_row(Answer& answer, const char* process, const std::string& name,
             const std::string& title) {
    answer.json["machines"].push_back({{"name", name}, {"process", process}, {"title", title}});
    answer.text += name + std::string(name.size() < 28 ? 28 - name.size() : 1, ' ') + title + "\n";
}

decomp::Result<Answer> list() {
    Answer answer;
    answer.json["machines"] = Json::array();
    for (const std::string& name : cam::profile::list_machines()) {
        const auto setup = cam::profile::read_fdm_setup(name);
        if (!setup) {
            return decomp::fail(setup.error());
        }
        add_row(answer, "fdm", name, setup->machine.title);
    }
    for (const std::string& name : cam::profile::list_mills()) {
        const auto setup = cam::profile::read_mill_setup(name);
        if (!setup) {
            return decomp::fail(setup.error());
        }
        add_row(answer, "mill", name, setup->machine.title);
    }
    return answer;
}

template <class Setup>
Answer explained(const Setup& setup) {
    Answer answer;
    answer.json["machine"] = setup.machine.name;
    answer.json["sha256"] = setup.hash;
    answer.json["fields"] = Json::array();
    for (const cam::profile::FieldRow& row : cam::profile::describe(setup)) {
        answer.json["fields"].push_back({{"section", row.section},
                                         {"key", row.key},
                                         {"value", row.value},
                                         {"unit", row.unit},
                                         {"range", row.range},
                                         {"doc", row.doc}});
    }
    answer.text = cam::profile::explain(setup);
    return answer;
}

bool is_mill(const std::string& name) {
    const std::vector<std::string> mills = cam::profile::list_mills();
    return std::find(mills.begin(), mills.end(), name) != mills.end() ||
           name.find("mill/") != std::string::npos;
}

decomp::Result<Answer> show(const std::string& name, const std::string& material,
                            const std::vector<std::string>& settings) {
    if (is_mill(name)) {
        const auto setup = cam::profile::read_mill_setup(name, {}, settings);
        return setup ? decomp::Result<Answer>(explained(*setup)) : decomp::fail(setup.error());
    }
    const auto setup = cam::profile::read_fdm_setup(name, material, settings);
    return setup ? decomp::Result<Answer>(explained(*setup)) : decomp::fail(setup.error());
}

}  // namespace

Action declare_machines(CLI::App& app, const Common& /*common*/) {
    struct Command {
        std::string what;
        std::string name;
        std::string material;
        std::vector<std::string> settings;
    };

    auto command = std::make_shared<Command>();
    app.add_option("what", command->what, "'show' explains one machine")
        ->check(CLI::IsMember({"show", "list"}));
    app.add_option("name", command->name, "profile to show");
    app.add_option("--material", command->material, "with this filament")->group("Machine");
    app.add_option("--set", command->settings, "with a value changed: KEY=VALUE")
        ->allow_extra_args(false)
        ->group("Machine");
    return [command](const decomp::Run&) -> decomp::Result<Answer> {
        if (command->what != "show") {
            return list();
        }
        if (command->name.empty()) {
            return decomp::fail("usage.machine", "'machines show' needs a name", {},
                                "see 'hew machines' for the names");
        }
        return show(command->name, command->material, command->settings);
    };
}

}  // namespace tools
