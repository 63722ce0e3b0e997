/* The functions of FMI 3.0 for what no model here has: variables of other types than Float64, clocks, structural
   parameters. They say so. */
#ifndef PC_FMI3_NONE_H
#define PC_FMI3_NONE_H

#define OF_NO_VARIABLE(name, type)                                                                                            \
    EXPORT fmi3Status FMI(fmi3Get##name)(fmi3Instance c, const fmi3ValueReference of[], size_t count, type values[],          \
                                         size_t value_count)                                                                  \
    {                                                                                                                         \
        (void)of;                                                                                                             \
        (void)values;                                                                                                         \
        (void)value_count;                                                                                                    \
        return none(c, count, "variable of this type");                                                                       \
    }                                                                                                                         \
    EXPORT fmi3Status FMI(fmi3Set##name)(fmi3Instance c, const fmi3ValueReference of[], size_t count, const type values[],    \
                                         size_t value_count)                                                                  \
    {                                                                                                                         \
        (void)of;                                                                                                             \
        (void)values;                                                                                                         \
        (void)value_count;                                                                                                    \
        return none(c, count, "variable of this type");                                                                       \
    }

OF_NO_VARIABLE(Float32, float)
OF_NO_VARIABLE(Int8, int8_t)
OF_NO_VARIABLE(UInt8, uint8_t)
OF_NO_VARIABLE(Int16, int16_t)
OF_NO_VARIABLE(UInt16, uint16_t)
OF_NO_VARIABLE(Int32, int32_t)
OF_NO_VARIABLE(UInt32, uint32_t)
OF_NO_VARIABLE(Int64, int64_t)
OF_NO_VARIABLE(UInt64, uint64_t)
OF_NO_VARIABLE(Boolean, fmi3Boolean)
OF_NO_VARIABLE(String, fmi3String)

EXPORT fmi3Status FMI(fmi3GetBinary)(fmi3Instance c, const fmi3ValueReference of[], size_t count, size_t sizes[],
                                     fmi3Binary values[], size_t value_count)
{
    (void)of;
    (void)sizes;
    (void)values;
    (void)value_count;
    return none(c, count, "variable of this type");
}

EXPORT fmi3Status FMI(fmi3SetBinary)(fmi3Instance c, const fmi3ValueReference of[], size_t count, const size_t sizes[],
                                     const fmi3Binary values[], size_t value_count)
{
    (void)of;
    (void)sizes;
    (void)values;
    (void)value_count;
    return none(c, count, "variable of this type");
}

EXPORT fmi3Status FMI(fmi3GetClock)(fmi3Instance c, const fmi3ValueReference of[], size_t count, fmi3Clock values[])
{
    (void)of;
    (void)values;
    return none(c, count, "clock");
}

EXPORT fmi3Status FMI(fmi3SetClock)(fmi3Instance c, const fmi3ValueReference of[], size_t count, const fmi3Clock values[])
{
    (void)of;
    (void)values;
    return none(c, count, "clock");
}

EXPORT fmi3Status FMI(fmi3GetNumberOfVariableDependencies)(fmi3Instance c, fmi3ValueReference of, size_t *count_of)
{
    (void)of;
    (void)count_of;
    return refuse(c, "dependency that changes");
}

EXPORT fmi3Status FMI(fmi3GetVariableDependencies)(fmi3Instance c, fmi3ValueReference dependent, size_t elements[],
                                                   fmi3ValueReference independents[], size_t elements_of_independents[],
                                                   fmi3DependencyKind kinds[], size_t dependencies)
{
    (void)dependent;
    (void)elements;
    (void)independents;
    (void)elements_of_independents;
    (void)kinds;
    (void)dependencies;
    return refuse(c, "dependency that changes");
}

EXPORT fmi3Status FMI(fmi3EnterConfigurationMode)(fmi3Instance c)
{
    return refuse(c, "structural parameter");
}

EXPORT fmi3Status FMI(fmi3ExitConfigurationMode)(fmi3Instance c)
{
    return refuse(c, "structural parameter");
}

EXPORT fmi3Status FMI(fmi3GetIntervalDecimal)(fmi3Instance c, const fmi3ValueReference of[], size_t count,
                                              fmi3Float64 intervals[], fmi3IntervalQualifier qualifiers[])
{
    (void)of;
    (void)intervals;
    (void)qualifiers;
    return none(c, count, "clock");
}

EXPORT fmi3Status FMI(fmi3GetIntervalFraction)(fmi3Instance c, const fmi3ValueReference of[], size_t count,
                                               fmi3UInt64 counters[], fmi3UInt64 resolutions[],
                                               fmi3IntervalQualifier qualifiers[])
{
    (void)of;
    (void)counters;
    (void)resolutions;
    (void)qualifiers;
    return none(c, count, "clock");
}

EXPORT fmi3Status FMI(fmi3GetShiftDecimal)(fmi3Instance c, const fmi3ValueReference of[], size_t count,
                                           fmi3Float64 shifts[])
{
    (void)of;
    (void)shifts;
    return none(c, count, "clock");
}

EXPORT fmi3Status FMI(fmi3GetShiftFraction)(fmi3Instance c, const fmi3ValueReference of[], size_t count,
                                            fmi3UInt64 counters[], fmi3UInt64 resolutions[])
{
    (void)of;
    (void)counters;
    (void)resolutions;
    return none(c, count, "clock");
}

EXPORT fmi3Status FMI(fmi3SetIntervalDecimal)(fmi3Instance c, const fmi3ValueReference of[], size_t count,
                                              const fmi3Float64 intervals[])
{
    (void)of;
    (void)intervals;
    return none(c, count, "clock");
}

EXPORT fmi3Status FMI(fmi3SetIntervalFraction)(fmi3Instance c, const fmi3ValueReference of[], size_t count,
                                               const fmi3UInt64 counters[], const fmi3UInt64 resolutions[])
{
    (void)of;
    (void)counters;
    (void)resolutions;
    return none(c, count, "clock");
}

EXPORT fmi3Status FMI(fmi3SetShiftDecimal)(fmi3Instance c, const fmi3ValueReference of[], size_t count,
                                           const fmi3Float64 shifts[])
{
    (void)of;
    (void)shifts;
    return none(c, count, "clock");
}

EXPORT fmi3Status FMI(fmi3SetShiftFraction)(fmi3Instance c, const fmi3ValueReference of[], size_t count,
                                            const fmi3UInt64 counters[], const fmi3UInt64 resolutions[])
{
    (void)of;
    (void)counters;
    (void)resolutions;
    return none(c, count, "clock");
}

EXPORT fmi3Status FMI(fmi3GetOutputDerivatives)(fmi3Instance c, const fmi3ValueReference of[], size_t count,
                                                const fmi3Int32 orders[], fmi3Float64 values[], size_t value_count)
{
    (void)of;
    (void)orders;
    (void)values;
    (void)value_count;
    return none(c, count, "derivative of an output");
}

EXPORT fmi3Status FMI(fmi3ActivateModelPartition)(fmi3Instance c, fmi3ValueReference clock, fmi3Float64 t)
{
    (void)clock;
    (void)t;
    return refuse(c, "scheduled execution");
}

#endif
