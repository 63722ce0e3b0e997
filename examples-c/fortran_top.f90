! The heavy top from Fortran 2008, by the interoperability of C that the language has.
!
! An interface for a function of pc.h is written from its declaration: a handle is type(c_ptr), by value where C has
! `pc_model *` and by reference where it has `pc_model **`; an array is assumed-size; a text ends with c_null_char.
module pc
    use, intrinsic :: iso_c_binding
    implicit none
    integer(c_int), parameter :: pc_ok = 0

    interface
        function pc_model_builtin(name, model, error) bind(c) result(status)
            import
            character(kind=c_char), intent(in) :: name(*)
            type(c_ptr), intent(out) :: model, error
            integer(c_int) :: status
        end function
        subroutine pc_model_free(model) bind(c)
            import
            type(c_ptr), value :: model
        end subroutine
        function pc_system_new(model, options, system, error) bind(c) result(status)
            import
            type(c_ptr), value :: model, options
            type(c_ptr), intent(out) :: system, error
            integer(c_int) :: status
        end function
        subroutine pc_system_free(system) bind(c)
            import
            type(c_ptr), value :: system
        end subroutine
        function pc_system_dim(system) bind(c) result(dim)
            import
            type(c_ptr), value :: system
            integer(c_size_t) :: dim
        end function
        function pc_system_start(system, t, y, y_length, error) bind(c) result(status)
            import
            type(c_ptr), value :: system
            real(c_double), intent(out) :: t, y(*)
            integer(c_size_t), value :: y_length
            type(c_ptr), intent(out) :: error
            integer(c_int) :: status
        end function
        function pc_system_energy(system, t, y, y_length, energy, error) bind(c) result(status)
            import
            type(c_ptr), value :: system
            real(c_double), value :: t
            real(c_double), intent(in) :: y(*)
            integer(c_size_t), value :: y_length
            real(c_double), intent(out) :: energy
            type(c_ptr), intent(out) :: error
            integer(c_int) :: status
        end function
        function pc_kernel_new(system, kernel, error) bind(c) result(status)
            import
            type(c_ptr), value :: system
            type(c_ptr), intent(out) :: kernel, error
            integer(c_int) :: status
        end function
        subroutine pc_kernel_free(kernel) bind(c)
            import
            type(c_ptr), value :: kernel
        end subroutine
        function pc_kernel_rhs(t, y, ydot, kernel) bind(c) result(code)
            import
            real(c_double), value :: t
            real(c_double), intent(in) :: y(*)
            real(c_double), intent(out) :: ydot(*)
            type(c_ptr), value :: kernel
            integer(c_int) :: code
        end function
        function pc_error_message(error) bind(c) result(message)
            import
            type(c_ptr), value :: error
            type(c_ptr) :: message
        end function
        subroutine pc_error_free(error) bind(c)
            import
            type(c_ptr), value :: error
        end subroutine
    end interface

contains

    ! Ends the program with the message of a call that failed.
    subroutine need(status, error)
        integer(c_int), intent(in) :: status
        type(c_ptr), intent(in) :: error
        character(kind=c_char), pointer :: letters(:)
        integer :: i
        if (status == pc_ok) return
        call c_f_pointer(pc_error_message(error), letters, [4096])
        do i = 1, size(letters)
            if (letters(i) == c_null_char) exit
            write (*, '(a)', advance='no') letters(i)
        end do
        write (*, *)
        call pc_error_free(error)
        stop 1
    end subroutine
end module

program top
    use pc
    implicit none
    integer, parameter :: steps = 20000
    ! The state at t = 10, from an integration with 34 digits.
    real(c_double), parameter :: reference(6) = [-0.5983375993973925_c_double, -0.1486439622069561_c_double, &
        0.7873354365496211_c_double, -0.06583376642272503_c_double, -0.2664489483922874_c_double, 3.0_c_double]
    type(c_ptr) :: model, system, kernel, error
    real(c_double) :: y(6), k(6, 4), t, h, before, after, off
    integer :: step, code

    call need(pc_model_builtin('heavy-top-lagrange' // c_null_char, model, error), error)
    call need(pc_system_new(model, c_null_ptr, system, error), error)
    call need(pc_kernel_new(system, kernel, error), error)
    if (pc_system_dim(system) /= size(y)) stop 1
    call need(pc_system_start(system, t, y, size(y, kind=c_size_t), error), error)
    call need(pc_system_energy(system, t, y, size(y, kind=c_size_t), before, error), error)

    ! The method of Runge and Kutta, with f called from Fortran.
    h = 10.0_c_double / steps
    do step = 0, steps - 1
        t = step * h
        code = pc_kernel_rhs(t, y, k(:, 1), kernel)
        code = max(code, pc_kernel_rhs(t + h/2, y + h/2 * k(:, 1), k(:, 2), kernel))
        code = max(code, pc_kernel_rhs(t + h/2, y + h/2 * k(:, 2), k(:, 3), kernel))
        code = max(code, pc_kernel_rhs(t + h, y + h * k(:, 3), k(:, 4), kernel))
        if (code /= 0) stop 1
        y = y + h/6 * (k(:, 1) + 2*k(:, 2) + 2*k(:, 3) + k(:, 4))
    end do

    off = maxval(abs(y - reference))
    call need(pc_system_energy(system, t + h, y, size(y, kind=c_size_t), after, error), error)
    print '(i0, a, es7.1, a, es8.1)', steps, ' steps of Runge and Kutta: off the reference by ', off, ', energy by ', &
        after - before
    print '(a)', 'pc run heavy-top-lagrange --rtol 1e-13 --atol 1e-15'
    print '(a, 6(1x, g0.17))', 't = 10:', y

    call pc_kernel_free(kernel)
    call pc_system_free(system)
    call pc_model_free(model)
    ! Order 4 with h = 5e-4: h^4 = 6e-14, times derivatives of order 100, and the rounding of 20000 steps.
    if (off > 1.0e-10_c_double .or. abs(after - before) > 1.0e-10_c_double) stop 1
end program
