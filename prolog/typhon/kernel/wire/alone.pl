:- module(typhon_alone,
          [ alone/1,                    % ?Address
            alone_begin/1,              % +Address
            alone_end/0,
            alone_request/4             % +Address, +Kind, +Term, :OnAnswer
          ]).
:- use_module('../base/on_demand', [on_demand_load/2]).
:- use_module(frame, [mobile_term/1]).
:- use_module(request, [request_answer/2, take_request/4]).

/** <module> An endpoint without a wire

A process without peers needs no sockets and no threads: what is
sent to its own address is taken at once, as a copy, by the thread that sends
it.  Other addresses cannot be reached.

*Threading*: any thread.
*/

:- meta_predicate alone_request(+, +, +, 1).

:- dynamic alone/1.                     % Address

%!  alone(?Address) is semidet.
%
%   The endpoint of this process is alone, and has this Address.

%!  alone_begin(+Address) is det.
%!  alone_end is det.

alone_begin(Address) :-
    assertz(alone(Address)).

alone_end :-
    retractall(alone(_)).

%!  alone_request(+Address, +Kind, +Term, :OnAnswer) is det.
%
%   As endpoint_request/4.

alone_request(Address, Kind, Term, OnAnswer) :-
    (   alone(Address)
    ->  mobile_term(Term),
        copy_term(Term, Copy),
        on_demand_load(requested, Kind), % time may stand still meanwhile
        (   take_request(Kind, Copy, Address, alone(OnAnswer))
        ->  true
        ;   request_answer(lost, OnAnswer)
        )
    ;   request_answer(unreachable, OnAnswer)
    ).
