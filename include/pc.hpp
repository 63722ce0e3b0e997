// pc for C++17: the handles of pc.h as objects that free themselves, failures as exceptions, arrays as views, functions
// of the program as lambdas.
//
//     pc::system top(pc::model::builtin("heavy-top-lagrange"));
//     pc::solver solver(top);
//     const pc::vector y = solver.advance(10.0);
//
// Each header below can be included alone. Objects can be moved but not copied, except by a
// clone(). What pc.h says of threads holds here: objects are independent, and each is used by one
// call at a time. get() gives the handle, for calls of C. Functions of the program may throw:
// catching.hpp says where the exception comes out.

#ifndef PC_HPP
#define PC_HPP

#include "pc/cancel.hpp"     // limits and cancellation
#include "pc/catching.hpp"   // exceptions of the program's functions
#include "pc/code.hpp"       // derived models that threads share and that are kept
#include "pc/checkpoint.hpp" // integrations that are resumed
#include "pc/dense.hpp"      // motions as functions of time
#include "pc/ensemble.hpp"   // many motions at once
#include "pc/error.hpp"      // calls that failed
#include "pc/event.hpp"      // events and observers
#include "pc/force.hpp"      // forces that functions of the program compute
#include "pc/kernel.hpp"     // the right-hand side for your own integrator
#include "pc/linearization.hpp" // equilibria, and linear equations near them
#include "pc/model.hpp"      // models from a text, or built call by call
#include "pc/options.hpp"    // how to integrate
#include "pc/solver.hpp"     // integration
#include "pc/system.hpp"     // equations of motion
#include "pc/view.hpp"       // numbers that another object owns

#endif // PC_HPP
