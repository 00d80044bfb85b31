:- module(typhon_page_slices,
          [ slices_begin/1,             % :Goal
            slices_end/0,
            slice_run/2                 % +Seconds, -When
          ]).
:- autoload('../../options/virtual',
            [virtual_paced/1, virtual_program/2, virtual_run/4]).
:- use_module(library(lists), [memberchk/2]).
:- use_module('../../kernel/host', [time_kind/1]).
:- use_module('../../kernel/base/error_text', [print_error/2]).

/** <module> A program beside the page, without threads

The program runs in an engine.  When it waits for virtual time, it leaves the
engine, and time runs in slices, between which the page handles other events; the
program goes on exactly when its wait ends.  Without a program time runs only
because the page wants it.

*Threading*: one thread.
*/

:- meta_predicate slices_begin(0).

:- dynamic
    program/2.                  % Engine, Wait: `none`, or virtual_wait(Queue, Stamp)

%!  slices_begin(:Goal) is det.
%!  slices_end is det.
%
%   Let Goal run to its first wait; end it, wherever it is.

slices_begin(Goal) :-
    virtual_program(ignore(Goal), Engine),
    assertz(program(Engine, none)),
    go_on(next, Engine).

slices_end :-
    forall(program(Engine, _),
           catch(engine_destroy(Engine), error(_, _), true)),
    retractall(program(_, _)).

go_on(How, Engine) :-
    retractall(program(Engine, _)),
    (   catch(step(How, Engine, Wait), error(Formal, Context),
              ( print_error(error, error(Formal, Context)), fail )),
        Wait = virtual_wait(_, _)
    ->  assertz(program(Engine, Wait))
    ;   catch(engine_destroy(Engine), error(_, _), true)
    ).

step(next, Engine, Wait) :- engine_next(Engine, Wait).
step(How, Engine, Wait) :- engine_post(Engine, How, Wait).

%!  slice_run(+Seconds, -When) is det.
%
%   Let time run at its pace for about Seconds of real time at most.  When is
%   after(More), if there is more to do after More seconds, or `rests`.

slice_run(_, rests) :-
    \+ time_kind(virtual),
    !.
slice_run(_, rests) :-
    \+ virtual_paced(_),
    !.
slice_run(Seconds, When) :-
    program(Engine, virtual_wait(Queue, Stamp)),
    !,
    virtual_run(Queue, Stamp, Seconds, How),
    after_slice(How, Engine, When).
slice_run(Seconds, When) :-
    setup_call_cleanup(
        message_queue_create(Queue),
        virtual_run(Queue, inf, Seconds, When),
        message_queue_destroy(Queue)).

after_slice(How, Engine, When) :-
    (   memberchk(How, [there, late])
    ->  go_on(How, Engine),
        When = after(0)
    ;   When = How
    ).
