// Calls in any order through pc.hpp, with functions of the program that throw now and then. The
// first exception comes out of the call that called them, and nothing else happens.
//
//     sequences [NUMBER]     plays NUMBER sequences, by default 300
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "pc.hpp"

namespace {

// Not an exception of any library.
struct thrown {
    unsigned long number;
};

class program {
public:
    explicit program(unsigned seed) : random_(seed) {}

    void play()
    {
        for (int calls = 1 + pick(25); calls > 0; calls--) {
            const unsigned long before = throws_;
            try {
                one();
                require(throws_ == before, "an exception was lost");
                done_++;
            } catch (const thrown &error) {
                require(throws_ > before && error.number == before + 1, "another exception than the first came out");
                caught_++;
            } catch (const pc::error &error) {
                require(throws_ == before, "an error took the place of an exception");
                require(error.status() != PC_OK && error.status() != PC_INTERNAL && *error.what(), error.what());
            } catch (const std::invalid_argument &) {
                require(throws_ == before, "a refusal took the place of an exception");
            }
        }
    }

    unsigned long done() const { return done_; }
    unsigned long caught() const { return caught_; }

private:
    static void require(bool right, const char *what)
    {
        if (!right) {
            std::fprintf(stderr, "%s\n", what);
            std::abort();
        }
    }
    int pick(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
    double number() { return pick(20) == 0 ? std::numeric_limits<double>::quiet_NaN() : 3.0 - 0.01 * pick(600); }

    // Throws now and then; otherwise returns the value, or NaN.
    double value(double right)
    {
        if (pick(400) == 0) {
            throw thrown{++throws_};
        }
        return pick(400) == 0 ? std::numeric_limits<double>::quiet_NaN() : right;
    }

    void begin()
    {
        pc::model model("Point");
        model.coordinate("x", 1.0).coordinate("y", 0.3).kinetic("(x'^2 + y'^2)/2").potential("x^2/2 + y^4/4");
        model.event("floor", "y", PC_FALLING).event_reset("floor", "y'", "-0.9*y'");
        if (pick(2) == 0) {
            model.external_force("x");
        }
        if (pick(3) == 0) {
            model.constraint("rail", "x' - y*y'");
        }
        solver_.reset();
        system_ = std::make_unique<pc::system>(model, pick(2) == 0 ? PC_POINCARE : PC_CANONICAL);
        system_->set_force(
            [this](double t, pc::view<const double> y, pc::view<double> q) { q[0] = value(0.1 * t - y[0]); },
            pick(2) == 0 ? pc::force_jacobian()
                         : [this](double, pc::view<const double>, pc::view<double> dq) {
                               for (double &entry : dq) {
                                   entry = 0.0;
                               }
                               dq[0] = value(-1.0);
                           });
    }

    void integrate()
    {
        pc::solver_options options;
        options.method = pick(2) == 0 ? PC_ADAMS : PC_BDF;
        options.max_steps = 300;
        solver_ = std::make_unique<pc::solver>(*system_, options);
        if (pick(2) == 0) {
            solver_->add_event(
                "own", PC_BOTH, pick(2) == 0, [this](double, pc::view<const double> y) { return value(y[0] - 0.5); },
                pick(2) == 0 ? pc::event_reset() : [this](double, pc::view<double> y) { y[0] = value(0.6); });
        }
        solver_->observe_events([this](const pc::occurrence &event) { return value(event.t) > -10.0; });
    }

    void one()
    {
        const int which = pick(12);
        if (!system_ || which == 0) {
            begin();
        } else if (!solver_ || which == 1) {
            integrate();
        } else {
            use(which);
        }
    }

    void use(int which)
    {
        const auto seen = [this](double t, pc::view<const double>) { return value(t) > -10.0; };
        pc::vector y(system_->dim(), 0.4), matrix(y.size() * y.size());
        const double times[] = {number(), number()};
        switch (which) {
        case 2: system_->rhs(number(), y); break;
        case 3: system_->jacobian(number(), y, matrix); break;
        case 4: system_->observe(number(), y); break;
        case 5: solver_->advance(number()); break;
        case 6: solver_->run(times, seen); break;
        case 7: solver_->step(number()); break;
        case 8: solver_->run_dense(number())(number()); break;
        case 9: pc::kernel(*system_).jacobian(number(), y, matrix); break;
        case 10: solver_ = std::make_unique<pc::solver>(pc::solver::restore(*system_, solver_->checkpoint())); break;
        default: {
            // Without forces: another thread would call them while the observer runs.
            const pc::system top(pc::model::builtin("euler-top"));
            const pc::vector states(3 * top.dim(), 0.2);
            pc::solver_options options;
            options.max_steps = 100;
            pc::run_ensemble(top, 0.0, states, {}, times,
                             [this](const pc::member &of) { return value(double(of.number)) > -10.0; }, 2, options);
        }
        }
    }

    std::mt19937 random_;
    std::unique_ptr<pc::system> system_;
    std::unique_ptr<pc::solver> solver_;
    unsigned long throws_ = 0, done_ = 0, caught_ = 0;
};

} // namespace

int main(int argc, char **argv)
{
    const unsigned long sequences = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 300;
    unsigned long done = 0, caught = 0;
    for (unsigned long i = 0; i < sequences; i++) {
        program of(static_cast<unsigned>(i));
        of.play();
        done += of.done();
        caught += of.caught();
    }
    std::printf("%lu sequences, %lu calls done, %lu exceptions caught\n", sequences, done, caught);
    return done > 2 * sequences && 20 * caught > sequences ? 0 : 1;
}
