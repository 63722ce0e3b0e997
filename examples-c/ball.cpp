// A ball in C++: events as lambdas, the motion as a function, a checkpoint, an ensemble.
#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

#include "pc.hpp"

int main()
{
    try {
        pc::model model("Ball");
        model.parameter("e", 0.8).coordinate("y", 1.0).kinetic("y'^2/2").potential("9.81*y");
        pc::system falling(model);
        model.event("bounce", "y", PC_FALLING).event_reset("bounce", "y'", "-e*y'");
        pc::system ball(model);
        pc::solver_options options;
        options.relative_tolerance = 1e-12;
        options.stop_time = 2.0;

        // It lands at t0 = √(2/g), next after 2 t0 e.
        const double t0 = std::sqrt(2.0 / 9.81);
        bool right = true;
        std::vector<double> bounces;
        pc::solver solver(ball, options);
        solver.observe_events([&](const pc::occurrence &event) {
            bounces.push_back(event.t);
            return true;
        });
        const pc::dense motion = solver.run_dense(1.5);
        std::printf("pc run bouncing-ball --rtol 1e-12 --t-end 2 --rows 5\n");
        std::printf("t = 1.5: %.17g %.17g\n", solver.state()[0], solver.state()[1]);
        right = right && bounces.size() == 2 && std::fabs(bounces[1] - 2.6 * t0) < 1e-9;
        right = right && std::fabs(motion(t0 / 2)[0] - 0.75) < 1e-9 && motion.t_end() == 1.5;
        right = right && solver.occurrences(0) == 2 && solver.last_occurrence(0)->t == bounces[1];

        right = right && std::fabs(motion.rate(t0 / 2)[1] + 9.81) < 1e-6; // the error of a polynomial over one step

        // The function and the reset of the event, for another integrator.
        double y[] = {0.25, -2.0}, height = 0.0;
        ball.events(0.0, y, {&height, 1});
        ball.reset(0, 0.0, y);
        right = right && height == 0.25 && y[0] == 0.25 && std::fabs(y[1] - 1.6) < 1e-15;
        right = right && ball.event_direction(0) == PC_FALLING && !ball.event_is_terminal(0) && ball.event_resets(0);

        // The same event by functions of the program, and a terminal event on the way up.
        pc::solver own(falling, options);
        own.add_event("floor", PC_FALLING, false, [](double, pc::view<const double> y) { return y[0]; },
                      [](double, pc::view<double> y) { y[1] *= -0.8; });
        own.add_event("caught", PC_RISING, true, [](double, pc::view<const double> y) { return y[0] - 0.3; });
        own.advance(2.0);
        right = right && own.event_names() == std::vector<std::string>{"floor", "caught"};
        right = right && own.ended_by() == std::size_t(1) && std::fabs(own.state()[0] - 0.3) < 1e-9;

        try {
            own.checkpoint(); // fails: a checkpoint cannot contain functions of the program
            right = false;
        } catch (const pc::error &error) {
            right = right && error.status() == PC_UNSUPPORTED;
        }

        // Restored from a checkpoint, the motion is the same to the last bit.
        pc::solver first(falling, options);
        first.advance(0.5);
        const pc::bytes bytes = first.checkpoint("falling");
        auto second = pc::solver::restore(falling, bytes, options);
        right = right && first.advance(1.0) == second.advance(1.0) && pc::checkpoint_label(bytes) == "falling";

        // Balls from many heights, one of them NaN.
        const double starts[] = {1.0, 0.0, std::numeric_limits<double>::quiet_NaN(), 0.0, 4.0, 0.0};
        std::vector<double> speeds;
        std::size_t failed = 0;
        pc::run_ensemble(falling, 0.0, starts, {}, {0.1, 0.4}, [&](const pc::member &member) {
            if (member.status == PC_OK) {
                speeds.push_back(member.state(1)[1]);
            } else {
                failed++;
                std::cout << "member " << member.number << ": " << member.message << '\n';
            }
            return true;
        });
        right = right && failed == 1 && speeds.size() == 2 && std::fabs(speeds[1] + 9.81 * 0.4) < 1e-8;
        try {
            pc::run_ensemble(falling, 0.0, starts, {}, {0.1}, [](const pc::member &) -> bool { throw 42; });
            right = false;
        } catch (int) {
        }

        // From the model's start, with two values of e: y' = e g t0 - g (t - t0) after the first
        // bounce. Stops after one.
        double slower = 0.0;
        const bool all = pc::run_ensemble(ball, 0.0, {}, {0.5, 0.9}, {0.5}, [&](const pc::member &member) {
            slower = member.state(0)[1];
            return false;
        });
        right = right && !all && std::fabs(slower - 9.81 * (1.5 * t0 - 0.5)) < 1e-8;
        std::cout << "bounces at " << bounces[0] << " and " << bounces[1] << '\n';
        return right ? 0 : 1; // tolerances of the integrations, 1e-12 and 1e-9, with room for a few steps
    } catch (const std::exception &error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
}
