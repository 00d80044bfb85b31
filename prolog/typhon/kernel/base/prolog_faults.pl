:- module(typhon_prolog_faults,
          [ forget_erased/0,
            functors_room/0,
            installed_swipl/2,          % +Home, -Program
            spawn/3,                    % +Program, +Args, +Options
            fast_bytes_term/2           % +Bytes, -Term
          ]).
:- use_module(library(error), [type_error/2]).
:- autoload(library(process), [process_create/3]).

/** <module> Faults of SWI-Prolog, and what keeps them away

They are those of 9.0.4; most are there in 10.1, too.

*Threading*: as said below; any thread otherwise.
*/

                /*******************************
                *  REFERENCES TO NO CLAUSES    *
                *******************************/

%   Loading, for one, leaves references to erased clauses on the stacks of the
%   thread that does it. As long as there are some, 9.0.4 collects atoms
%   whenever it collects clauses: every dozen hops, for a quarter of what they
%   cost. For the same reason no table that changes with each hop is changed by
%   clause references.

%!  forget_erased is det.
%
%   Forget those that no table holds any more.

forget_erased :-
    garbage_collect,
    garbage_collect_atoms.

                /*******************************
                *           FUNCTORS           *
                *******************************/

%   A functor that one thread makes while another makes the table of all
%   functors larger may be missing in the new table, on 9.0.4 and on 10.1. A
%   thread that names it later gets a second one, and a term of the one never
%   unifies with the same term of the other: a predicate that is there is not
%   found. The table grows at each power of two, for ever, as no functor goes
%   away.
%
%   So it grows before threads begin, beyond what the programs of most hosts
%   need. A process that has read library(typhon) has 8,700 functors, one that
%   begins with a saved state of it 7,800: there the table grew, at 8,192, just
%   when its first agents were read.

%!  functors_room is det.
%
%   The table does not grow for the next 16,000 functors: 0.5 MB and 2 ms, once.
%   No other thread makes functors meanwhile.

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

%   Of the pipes to a process that begins, any other that begins in that moment
%   gets the ends, too (SWI-Prolog 9.0.4 to 10.1): it holds them open for as
%   long as it lives, and a reader that waits until a pipe ends waits for both.

%!  installed_swipl(+Home, -Program:atom) is semidet.
%
%   The program of the Prolog that has this Home.  The flag `executable` may name a
%   saved state instead, which runs its own goal.

installed_swipl(Home, Swipl) :-
    current_prolog_flag(arch, Arch),
    atomic_list_concat([Home, bin, Arch, swipl], /, Swipl),
    exists_file(Swipl).

%!  spawn(+Program, +Args:list, +Options:list) is det.
%
%   As process_create/3. Its pipes are known to this process and the new one
%   alone, if all that begin here are begun so.
%
%   @error as process_create/3

spawn(Program, Args, Options) :-
    with_mutex(typhon_prolog_faults, process_create(Program, Args, Options)).

                /*******************************
                *       TERMS FROM BYTES       *
                *******************************/

%   fast_term_serialized/2 is not safe with threads, on 9.0.4 and on
%   10.1: atoms that only the new term has are lost if another thread collects
%   atoms while it is made. The collector walks the global stack from term to
%   term, to find atoms that are in use; where the new term is not complete yet
%   there is what was there before, of which some looks as if it were the head
%   of something large, and it goes on beyond the end.
%
%   Where there is nothing but unbound variables it walks on.
%
%   Bytes may say that a variable has attributes, such as a goal that runs when
%   the variable is bound. No such term is read.

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

%   words(+Bytes, -Words): the term takes so many on the global stack at most.
%   No byte makes more than one and a half; for large ones it is read from the
%   head, where it follows the kind and the number of bytes.

words(Bytes, Words) :-
    string_length(Bytes, Length),
    (   Length < 4096
    ->  Words is 2*Length
    ;   number_at(2, Bytes, 0, _, I),
        number_at(I, Bytes, 0, Words, _)
    ).

%   Seven bits a byte, the highest first; the last byte has no eighth bit.

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
