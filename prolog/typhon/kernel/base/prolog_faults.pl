:- module(typhon_prolog_faults,
          [ collect_clauses_less_often/0,
            forget_erased/0,
            functors_room/0,
            installed_swipl/2,          % +Home, -Program
            spawn/3,                    % +Program, +Args, +Options
            fast_bytes_term/2           % +Bytes, -Term
          ]).
:- use_module(library(error), [type_error/2]).
:- autoload(library(process), [process_create/3]).

/** <module> Faults of SWI-Prolog, and their workarounds

The faults are those of 9.0.4; most of them are also in 10.1.

*Threading*: as documented below; any thread otherwise.
*/

                /*******************************
                *        ERASED CLAUSES        *
                *******************************/

%   Loading, among other operations, leaves references to erased clauses on the
%   stacks of its thread. As long as there are some, 9.0.4 collects atoms
%   whenever it collects clauses, for a quarter of the cost of hops. For the
%   same reason tables that change with each hop do not use clause references.

%!  forget_erased is det.
%
%   Clear the references to erased clauses that no table holds.  With much data
%   on the stack of the caller that takes longer than it saves, so then nothing
%   is done.

forget_erased :-
    statistics(globalused, Bytes),
    (   Bytes < 1 000 000
    ->  garbage_collect
    ;   true
    ).

%   Prolog collects erased clauses when its threads have skipped so many of them
%   that a look at all stacks costs less. By default it does so every dozen
%   hops. With a factor of 0.25 these cost less, and to replace a clause time
%   and again costs as much as before; from 2.0 on that costs more.

%!  collect_clauses_less_often is det.
%
%   No effect if the factor of this process is not the default.

collect_clauses_less_often :-
    (   predicate_property(system:'$cgc_params'(_, _, _, _, _, _), defined),
        '$cgc_params'(Space, 0.03, Clauses, Space, 0.25, Clauses)
    ->  true
    ;   true
    ).

                /*******************************
                *           FUNCTORS           *
                *******************************/

%   A functor that one thread creates while another enlarges the table of all
%   functors may be missing in the new table, on 9.0.4 and on 10.1. A thread
%   that uses the functor later gets a second one, and a term of the one never
%   unifies with the same term of the other: a predicate that exists is not
%   found. The table grows at each power of two, without end, as functors are
%   never deleted.
%
%   So the table grows before threads begin, beyond the needs of the programs
%   of most hosts. A process that has loaded library(typhon) has 8,700
%   functors, one that starts from a saved state 7,800: there the table grew,
%   at 8,192, just when its first agents were read.

%!  functors_room is det.
%
%   Make room for the next 16,000 functors: 0.5 MB and 2 ms, once. No other
%   thread may create functors meanwhile.

functors_room :-
    between(50, inf, Arity),
    current_atom(Name),
    functor(_, Name, Arity),
    statistics(functors, Count),
    Count > 0x4001,
    !.

                /*******************************
                *          PROCESSES           *
                *******************************/

%   A process that starts inherits the pipe ends of all processes that start at
%   the same moment (SWI-Prolog 9.0.4 to 10.1). It keeps them open as long as it
%   lives, so a reader of such a pipe sees the end only when both processes have
%   ended.

%!  installed_swipl(+Home, -Program:atom) is semidet.
%
%   Program is the executable of the Prolog with this Home. The flag
%   `executable` may name a saved state instead, which runs its own goal.

installed_swipl(Home, Swipl) :-
    current_prolog_flag(arch, Arch),
    atomic_list_concat([Home, bin, Arch, swipl], /, Swipl),
    exists_file(Swipl).

%!  spawn(+Program, +Args:list, +Options:list) is det.
%
%   As process_create/3. No third process inherits its pipes, if all processes
%   that start here are started by spawn/3.
%
%   @error as process_create/3

spawn(Program, Args, Options) :-
    with_mutex(typhon_prolog_faults, process_create(Program, Args, Options)).

                /*******************************
                *       TERMS FROM BYTES       *
                *******************************/

%   fast_term_serialized/2 is not safe with threads, on 9.0.4 and on 10.1:
%   atoms that occur only in the new term are lost if another thread collects
%   atoms while the term is made. To find the atoms in use, the collector walks
%   the global stack from term to term. In the incomplete new term it finds old
%   contents; some of them look like the head of a large term, and the collector
%   skips to a place beyond the end.
%
%   So the space is first filled with unbound variables, which the collector
%   passes correctly.
%
%   Bytes may contain a variable with attributes, such as a goal that runs when
%   the variable is bound. Such a term is refused.

%!  fast_bytes_term(+Bytes, -Term) is det.
%
%   The inverse of fast_term_serialized/2.  Never call this on the bytes of
%   a peer that is not authenticated.
%
%   @error type_error(mobile_term, attributed_variable)

fast_bytes_term(Bytes, Term) :-
    words(Bytes, Words),
    cleared(Words),
    fast_term_serialized(Read, Bytes),
    (   term_attvars(Read, [])
    ->  Term = Read
    ;   type_error(mobile_term, attributed_variable)
    ).

%   words(+Bytes, -Words): the term takes at most Words words on the global
%   stack. A byte makes at most one and a half. Large terms state the number in
%   their head, after the kind and the number of bytes.

words(Bytes, Words) :-
    string_length(Bytes, Length),
    (   Length < 4096
    ->  Words is 2*Length
    ;   number_at(2, Bytes, 0, _, I),
        number_at(I, Bytes, 0, Words, _)
    ).

%   Seven bits a byte, the highest first. The eighth bit of the last byte is 0.

number_at(I, Bytes, N0, N, End) :-
    string_code(I, Bytes, Code),
    N1 is N0<<7 \/ (Code /\ 0x7f),
    I1 is I+1,
    (   Code < 0x80
    ->  N = N1,
        End = I1
    ;   number_at(I1, Bytes, N1, N, End)
    ).

cleared(Words) :-
    functor(_, cleared, Words),
    fail.
cleared(_).
