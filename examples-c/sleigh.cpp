// Chaplygin's sleigh in C++: handles that free themselves, errors as exceptions, an observer that is a lambda.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

#include "pc.hpp"

// The failure of a call; PC_OK if there is none.
template <class Call> pc::error failure(Call call)
{
    try {
        call();
    } catch (const pc::error &error) {
        return error;
    }
    return pc::error(PC_OK, nullptr);
}

int main()
{
    try {
        auto model = pc::model::builtin("chaplygin-sleigh");
        model.set("a", 0.5).observe_reactions();
        pc::system sleigh(model);

        pc::solver_options options;
        options.relative_tolerance = 1e-11;
        pc::solver solver(sleigh, options);

        // From v = 0, ω = 1: v = W tanh kt, ω = sech kt, W = √((J + m a²)/m), k = a/W (Chaplygin 1911).
        const double w = std::sqrt(1.25), k = 0.5 / w;
        double worst = 0.0, pressure = 0.0;
        std::vector<double> times;
        for (int i = 1; i <= 50; i++) {
            times.push_back(0.1 * i);
        }
        const bool completed = solver.run(times, [&](double t, pc::view<const double> y) {
            worst = std::fmax(worst, std::fabs(y[3] - w * std::tanh(k * t)));
            if (t == 4.0) {
                std::printf("pc run chaplygin-sleigh --rtol 1e-11 --rows 51\n");
                std::printf("t = 4: %.17g %.17g %.17g %.17g %.17g\n", y[0], y[1], y[2], y[3], y[4]);
            }
            worst = std::fmax(worst, std::fabs(y[4] - 1.0 / std::cosh(k * t)));
            // The reaction of the blade is 4/5 v ω.
            sleigh.reactions(t, y, {&pressure, 1});
            worst = std::fmax(worst, std::fabs(pressure - 0.8 * y[3] * y[4]));
            return true;
        });
        std::cout << sleigh.print(PC_TEXT) << "off the closed form by " << worst << '\n';

        // What an observer throws comes out of the run.
        bool caught = false;
        try {
            solver.run({6.0, 7.0}, [](double, pc::view<const double>) -> bool { throw 42; });
        } catch (int) {
            caught = true;
        }
        // The error of a wrong model says where it is wrong, and what would be right.
        bool right = failure([&] { pc::model::from_file("no such file"); }).status() == PC_NOT_FOUND;
        right = right && failure([&] { model.set("c", 1.0); }).status() == PC_NOT_FOUND;
        const std::string text = "[coordinates]\nx = 1.0\n[lagrangian]\nkinetic = \"x'^^2\"\n";
        const pc::error error = failure([&] { pc::model::parse(text); });
        std::cout << error.what() << '\n';
        right = right && error.status() == PC_INVALID_MODEL && error.line() == 4 && error.column() == 15;
        right = right && text.substr(error.offset(), error.length()) == "^" && error.integrator_code() == 0;

        // A start off the constraints is refused, unless it is moved onto them.
        const auto names = pc::model::builtin_names();
        right = right && std::count(names.begin(), names.end(), "vertical-disk") == 1;
        auto disk = pc::model::builtin("vertical-disk");
        disk.start("X'", 2.0);
        right = right && failure([&] { pc::system off(disk); }).status() == PC_INCONSISTENT_MODEL;
        pc::system moved(disk.project_start());
        right = right && std::fabs(moved.constraint_residuals(0.0, moved.start().second)[0]) < 1e-13; // rounding

        // A tolerance of 1e-11, times the growth of the error in a few hundred steps.
        return completed && caught && right && worst < 1e-8 ? 0 : 1;
    } catch (const std::exception &error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
}
