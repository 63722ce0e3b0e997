// Exceptions of the program's functions come out of the call that called them, on its thread.
#include <cmath>
#include <iostream>
#include <memory>
#include <thread>

#include "pc.hpp"

namespace {

struct too_low {
    double y;
};

// Whether the call throws too_low.
template <class Call> bool throws(Call call)
{
    try {
        call();
        return false;
    } catch (const too_low &) {
        return true;
    }
}

// The height, which throws below -1.
double height(pc::view<const double> y) { return y[0] < -1.0 ? throw too_low{y[0]} : y[0]; }

// A body that sinks by y = 1 - t, to the floor at t = 1.
pc::model sinking()
{
    pc::model model("Sinking");
    model.coordinate("y", 1.0).quasi_velocity("y'", -1.0).kinetic("y'^2/2");
    return model;
}

bool of_forces()
{
    const auto user = std::make_shared<int>(0);
    const pc::vector high{1.0, -1.0}, low{-2.0, -1.0};
    pc::vector ydot(2);
    bool right = true;
    {
        pc::system system(sinking().external_force("y").output("a", "d(y')"));
        system.set_force([user](double, pc::view<const double> y, pc::view<double> q) { q[0] = 0.0 * height(y); });
        pc::system copy = system.clone();
        pc::kernel kernel(system);
        pc::solver solver(system);
        right = right && throws([&] { system.rhs(0.0, low); }) && throws([&] { copy.jacobian(0.0, low); });
        right = right && throws([&] { system.observe(0.0, low); }); // C would succeed
        right = right && throws([&] { kernel(0.0, low, ydot); });
        right = right && throws([&] { solver.advance(3.0); }) && solver.time() > 0.0 && solver.state()[0] > -1.0;

        // Where a program calls C directly, a catching keeps the exception, but not that of another
        // thread.
        pc::catching thrown;
        const auto call = [&] { return pc_kernel_rhs(0.0, low.data(), ydot.data(), kernel.get()); };
        std::thread(call).join();
        thrown.rethrow();
        right = right && call() == -1 && throws([&] { thrown.rethrow(); });
        thrown.rethrow(); // nothing is kept any more

        // In an ensemble, only the members that threw have failed, on whatever thread.
        std::size_t failed = 0, told = 0;
        right = right && throws([&] {
            const double starts[] = {1.0, -1.0, -2.0, -1.0, 2.0, -1.0, -0.95, -1.0};
            pc::run_ensemble(copy, 0.0, starts, {}, {0.1}, [&](const pc::member &of) {
                failed += of.status == PC_OK ? 0 : 1;
                return ++told < 9;
            });
        });
        right = right && told == 4 && failed == 2 && kernel(0.0, high, ydot) == 0 && user.use_count() == 2;
    }
    return right && user.use_count() == 1; // freed with the last handle that shared it
}

bool of_events()
{
    const pc::system system(sinking());
    pc::solver_options options;
    options.initial_step = 2.5; // past the floor in its middle, to -1.5
    const auto solver = [&](pc::event_function function, pc::event_reset reset) {
        pc::solver made(system, options);
        made.add_event("floor", PC_FALLING, true, function, reset);
        return made;
    };
    const auto or_nan = [](double, pc::view<const double> y) { return y[0] < -1.0 ? std::nan("") : y[0]; };
    const auto or_throw = [](double, pc::view<const double> y) { return height(y); };
    const auto refuse = [](double, pc::view<double> y) { throw too_low{y[0]}; };

    // After an event, NaN is no failure. But an exception is never lost: it ends the call before
    // the step.
    pc::solver nan = solver(or_nan, nullptr), thrown = solver(or_throw, nullptr), refused = solver(or_nan, refuse);
    nan.advance(3.0);
    bool right = nan.ended_by() == std::size_t(0) && std::fabs(nan.time() - 1.0) < 1e-12; // located to rounding
    right = right && throws([&] { thrown.advance(3.0); }) && thrown.time() == 0.0 && thrown.occurrences(0) == 0;
    right = right && throws([&] { refused.advance(3.0); }) && refused.time() < 1.0 + 1e-12;

    // Exceptions of observers.
    pc::solver watched = solver(or_nan, nullptr), run(system);
    watched.observe_events([](const pc::occurrence &event) -> bool { throw too_low{event.after[0]}; });
    right = right && throws([&] { watched.run_dense(3.0); }) && watched.occurrences(0) == 1;
    right = right && throws([&] { run.run({0.1, 0.2}, [](double, auto y) -> bool { throw too_low{y[0]}; }); });
    return right && run.time() == 0.1 && !run.run({0.2, 0.3}, [](double, auto) { return false; }) && run.time() == 0.2;
}

} // namespace

int main()
{
    try {
        const bool forces = of_forces(), events = of_events();
        std::cout << "what is thrown comes out: " << (forces && events ? "yes" : "no") << '\n';
        return forces && events ? 0 : 1;
    } catch (const std::exception &error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
}
