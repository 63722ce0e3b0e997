// Chaplygin's sleigh in C++: handles that free themselves, errors as exceptions, an observer that is a lambda.
#include <cmath>
#include <cstdio>
#include <iostream>
#include <vector>

#include "pc.hpp"

int main()
{
    try {
        auto model = pc::model::builtin("chaplygin-sleigh");
        model.set("a", 0.5).observe_reactions();
        pc::system sleigh(model);

        auto options = pc::solver::default_options();
        options.relative_tolerance = 1e-11;
        pc::solver solver(sleigh, options);

        // From v = 0, ω = 1: v = W tanh kt, ω = sech kt, W = √((J + m a²)/m), k = a/W (Chaplygin 1911).
        const double w = std::sqrt(1.25), k = 0.5 / w;
        double worst = 0.0;
        std::vector<double> times;
        for (int i = 1; i <= 50; i++) {
            times.push_back(0.1 * i);
        }
        const bool completed = solver.run(times, [&](double t, const std::vector<double> &y) {
            worst = std::fmax(worst, std::fabs(y[3] - w * std::tanh(k * t)));
            worst = std::fmax(worst, std::fabs(y[4] - 1.0 / std::cosh(k * t)));
            // The blade presses with 4/5 v ω.
            worst = std::fmax(worst, std::fabs(sleigh.reactions(t, y).at(0) - 0.8 * y[3] * y[4]));
            return true;
        });
        std::cout << sleigh.print(PC_TEXT) << "off the closed form by " << worst << '\n';

        // What an observer throws comes out of the run.
        bool caught = false;
        try {
            solver.run({6.0, 7.0}, [](double, const std::vector<double> &) -> bool { throw 42; });
        } catch (int) {
            caught = true;
        }
        // A model that is wrong says where.
        try {
            pc::model::parse("[coordinates]\nx = 1.0\n[lagrangian]\nkinetic = \"x'^^2\"\n");
            return 1;
        } catch (const pc::error &error) {
            std::cout << error.what() << '\n';
            caught = caught && error.status() == PC_INVALID_MODEL && error.line() == 4;
        }
        // Tolerance 1e-11, times the growth of the error in some hundred steps.
        return completed && caught && worst < 1e-8 ? 0 : 1;
    } catch (const std::exception &error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
}
