# The heavy top from Julia, by ccall: julia julia_top.jl, with libpc where the loader finds it, or PC_LIBRARY=/where/libpc.so.
#
# A handle is Ptr{Cvoid}, a place for one Ref{Ptr{Cvoid}}; matrices are column-major, as Julia's own are.

const LIBRARY = get(ENV, "PC_LIBRARY", "libpc")
const Handle = Ptr{Cvoid}

"Throws the message of a call that failed."
function need(status::Cint, error::Ref{Handle})
    status == 0 && return
    message = unsafe_string(ccall((:pc_error_message, LIBRARY), Cstring, (Handle,), error[]))
    ccall((:pc_error_free, LIBRARY), Cvoid, (Handle,), error[])
    throw(ErrorException(message))
end

"The equations of a built-in model; freed with the last reference."
mutable struct System
    handle::Handle
    function System(name::AbstractString)
        model, system, error = Ref{Handle}(C_NULL), Ref{Handle}(C_NULL), Ref{Handle}(C_NULL)
        need(ccall((:pc_model_builtin, LIBRARY), Cint, (Cstring, Ref{Handle}, Ref{Handle}), name, model, error), error)
        status = ccall((:pc_system_new, LIBRARY), Cint, (Handle, Ptr{Cvoid}, Ref{Handle}, Ref{Handle}),
                       model[], C_NULL, system, error)
        ccall((:pc_model_free, LIBRARY), Cvoid, (Handle,), model[])
        need(status, error)
        finalizer(s -> ccall((:pc_system_free, LIBRARY), Cvoid, (Handle,), s.handle), new(system[]))
    end
end

dim(s::System) = Int(ccall((:pc_system_dim, LIBRARY), Csize_t, (Handle,), s.handle))

"Time and state at the start."
function start(s::System)
    t, y, error = Ref(0.0), zeros(dim(s)), Ref{Handle}(C_NULL)
    need(ccall((:pc_system_start, LIBRARY), Cint, (Handle, Ref{Cdouble}, Ptr{Cdouble}, Csize_t, Ref{Handle}),
               s.handle, t, y, length(y), error), error)
    t[], y
end

"f(t, y)"
function rates(s::System, t::Real, y::Vector{Float64})
    ydot, error = similar(y), Ref{Handle}(C_NULL)
    need(ccall((:pc_system_rhs, LIBRARY), Cint,
               (Handle, Cdouble, Ptr{Cdouble}, Csize_t, Ptr{Cdouble}, Csize_t, Ref{Handle}),
               s.handle, t, y, length(y), ydot, length(ydot), error), error)
    ydot
end

"∂f/∂y, a Matrix"
function jacobian(s::System, t::Real, y::Vector{Float64})
    matrix, error = zeros(length(y), length(y)), Ref{Handle}(C_NULL)
    need(ccall((:pc_system_jacobian, LIBRARY), Cint,
               (Handle, Cdouble, Ptr{Cdouble}, Csize_t, Ptr{Cdouble}, Csize_t, Ref{Handle}),
               s.handle, t, y, length(y), matrix, length(matrix), error), error)
    matrix
end

"The method of Runge and Kutta with steps of equal length."
function runge_kutta(f, t, y, h, steps)
    for i in 0:steps-1
        s = t + i * h
        k1 = f(s, y)
        k2 = f(s + h / 2, y + h / 2 * k1)
        k3 = f(s + h / 2, y + h / 2 * k2)
        k4 = f(s + h, y + h * k3)
        y += h / 6 * (k1 + 2k2 + 2k3 + k4)
    end
    y
end

function main()
    top = System("heavy-top-lagrange")
    t, y0 = start(top)
    # The state at t = 10, from an integration with 34 digits.
    reference = [-0.5983375993973925, -0.1486439622069561, 0.7873354365496211,
                 -0.06583376642272503, -0.2664489483922874, 3.0]
    y = runge_kutta((t, y) -> rates(top, t, y), t, y0, 5e-4, 20000)
    off = maximum(abs.(y - reference))
    # Along the motion f changes as its Jacobian says.
    h = 1e-6
    f = rates(top, t, y0)
    slope = (rates(top, t, y0 + h * f) - rates(top, t, y0 - h * f)) / 2h
    differs = maximum(abs.(jacobian(top, t, y0) * f - slope))
    println("20000 steps of Runge and Kutta: off the reference by $off; the Jacobian differs from differences by $differs")
    println("pc run heavy-top-lagrange --rtol 1e-13 --atol 1e-15\nt = 10: ", join(y, " "))
    # h^4 = 6e-14 times derivatives of order 100 and the rounding of 20000 steps; the error of a quotient is 1e-16/h + h^2.
    off > 1e-10 || differs > 1e-8 ? 1 : 0
end

exit(main())
