:- module(typhon_gpio_service, []).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error),
              [ domain_error/2, existence_error/2, must_be/2,
                permission_error/3 ]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module('../../kernel/base/options', [check_options/2]).
:- use_module('../common',
              [ service_begin/5, subscribe/5 as subscribe_to, subscriber/2,
                subscribers_drop/4, subscribers_notify/5,
                unsubscribe/4 as unsubscribe_from ]).
:- use_module('../helper',
              [ helper_call/5, helper_close/1, helper_file/2, helper_open/3,
                helper_python/2 ]).

/** <module> Pins of a board on a host

The helper bridges/gpio/bridge.py has the pins.  A restarted helper opens them
again, with their initial values; those that it cannot open when they are used.

*Threading*: any thread; predicates of agents run in the thread of the agent.
The thread that reads from the helper delivers edges.
*/

:- multifile
    typhon_starting:starts/4,
    typhon_starting:ends/2,
    typhon_helper_owner:again/2,
    typhon_helper_owner:handle_message/2,
    typhon_options:declared/4,
    prolog:message//1.

:- dynamic
    started/2,                  % Host, Options
    known_pin/4.                % Host, Name, Kind, Request: opens the pin

most_pins(200).
start_seconds(30).

typhon_starting:starts(gpio, Host, Pins, Options) :-
    check_options(gpio_option, Options),
    must_be(list, Pins),
    maplist(pin_request, Pins, Requests),
    service_begin(gpio, Host,
                  [ pin/2, pins/1, pin_watch/1, pin_watch/2, pin_unwatch/1,
                    pin_open/2, pin_close/1, pin_drive/2 ],
                  typhon_gpio_service,
                  connect(Host, Requests, Options)).

connect(Host, Requests, Options) :-
    assertz(started(Host, Options)),
    helper_python(Options, Python),
    helper_file('gpio/bridge.py', File),
    findall(Argument, argument(Options, Argument), Arguments),
    helper_open(gpio(Host), command(Python, ['-u',File|Arguments]),
                [restart(always)]),
    forall(member(Request, Requests), open_pin(Host, Request)).

argument(Options, Argument) :-
    member(Name, [factory,w1]),
    Option =.. [Name,Value],
    option(Option, Options),
    format(atom(Argument), '--~w=~w', [Name, Value]).

typhon_options:declared(gpio_option, Option, Type, Value) :-
    option_type(Option, Type, Value).

option_type(factory(X), oneof([mock,lgpio,rpigpio,pigpio,native]), X).
option_type(w1(X), atom, X).
option_type(open(X), boolean, X).
option_type(queue(X), positive_integer, X).
option_type(timeout(X), between(0.001, 3600), X).
option_type(python(X), atom, X).

typhon_starting:ends(gpio, Host) :-
    helper_close(gpio(Host)),
    retractall(started(Host, _)),
    retractall(known_pin(Host, _, _, _)).

%   gpio_option(+Host, +Option, +Default) is det.
%
%   As option/3, for the options with which Host was started.
%
%   @error existence_error(gpio, Host) if it was stopped meanwhile

gpio_option(Host, Option, Default) :-
    (   started(Host, Options)
    ->  option(Option, Options, Default)
    ;   existence_error(gpio, Host)
    ).

                /*******************************
                *             PINS             *
                *******************************/

%   pin_request(+Pin, -Request:dict) is det.
%
%   Pin is Name=Kind(Number) or Name=Kind(Number, Options), Request opens it.
%
%   @error domain_error(pin, Pin), domain_error(pin_option(Kind), Option)

pin_request(Name=Spec, Request) :-
    must_be(atom, Name),
    compound(Spec),
    Spec =.. [Kind,Number|More],
    options(More, Options),
    kind(Kind),
    number_of(Kind, Number),
    !,
    check_options(pin_option(Kind), Options),
    findall(Key-Value, setting(Kind, Options, Key, Value), Settings),
    dict_pairs(Given, _, Settings),
    Request = Given.put(_{do:open, pin:Name, kind:Kind, number:Number}).
pin_request(Pin, _) :-
    must_be(ground, Pin),
    domain_error(pin, Pin).

options([], []).
options([Options], Options) :-
    must_be(list, Options).

kind(output).
kind(input).
kind(pwm).
kind(thermometer).

number_of(thermometer, Name) :-
    !,
    atom(Name).
number_of(_, Number) :-
    integer(Number),
    !,
    between(0, 1000, Number).
number_of(_, Name) :-
    atom(Name).

typhon_options:declared(pin_option(Kind), Option, Type, Value) :-
    pin_option(Kind, Option, Type, Value, _).

%   pin_option(?Kind, ?Option, ?Type, ?Value, ?Default)

pin_option(output, active(X), oneof([high,low]), X, high).
pin_option(output, initial(X), oneof([0,1]), X, 0).
pin_option(input, active(X), oneof([high,low]), X, high).
pin_option(input, pull(X), oneof([none,up,down]), X, none).
pin_option(input, debounce(X), between(0.0, 60.0), X, 0).
pin_option(pwm, active(X), oneof([high,low]), X, high).
pin_option(pwm, initial(X), between(0.0, 1.0), X, 0).
pin_option(pwm, frequency(X), between(1.0, 10000.0), X, 100).

setting(Kind, Options, Key, Value) :-
    pin_option(Kind, Option, _, Value, Default),
    functor(Option, Key, 1),
    option(Option, Options, Default).

open_pin(Host, Request) :-
    Name = Request.pin,
    Kind = Request.kind,
    with_mutex(typhon_gpio, remember(Host, Name, Kind, Request)),
    catch(ask(Host, Request, _), error(Formal, Context),
          ( retractall(known_pin(Host, Name, _, _)),
            throw(error(Formal, Context)) )).

remember(Host, Name, Kind, Request) :-
    (   known_pin(Host, Name, _, _)
    ->  permission_error(open, pin, Name)
    ;   most_pins(Most),
        aggregate_all(count, known_pin(Host, _, _, _), Count),
        Count >= Most
    ->  throw(error(resource_error(pins), _))
    ;   assertz(known_pin(Host, Name, Kind, Request))
    ).

%   the_pin(+Name, -Host, -Kind) is det.

the_pin(Name, Host, Kind) :-
    subscriber(Host, _),
    must_be(atom, Name),
    (   known_pin(Host, Name, Kind0, _)
    ->  Kind = Kind0
    ;   existence_error(pin, Name)
    ).

                /*******************************
                *           REQUESTS           *
                *******************************/

%   ask(+Host, +Request, -Reply) is det.
%
%   @error existence_error(gpio_pin, Number), permission_error(use, gpio_pin, Number),
%   gpio_error(Problem, Host), where Problem is no_pins, silent or failed, and
%   others of pin/2 and helper_call/5

ask(Host, Request, Reply) :-
    gpio_option(Host, timeout(Seconds0), 10),
    get_dict(do, Request, Do),
    seconds(Do, Seconds0, Seconds),
    helper_call(gpio(Host), Request, Seconds, failure(Host, Request), Reply).

%   gpiozero takes some seconds to start on a small board.

seconds(open, Seconds0, Seconds) :-
    !,
    start_seconds(Start),
    Seconds is max(Start, Seconds0).
seconds(_, Seconds, Seconds).

failure(Host, Request, said(Dict), error(Formal, context(_, Message))) :-
    _{error:Text, message:Message} :< Dict,
    atom_string(Kind, Text),
    formal(Kind, Host, Request, Formal).

formal(no_gpiozero, _, _, existence_error(python_module, gpiozero)).
formal(no_pins, Host, _, gpio_error(no_pins, Host)).
formal(silent, Host, _, gpio_error(silent, Host)).
formal(exception, Host, _, gpio_error(failed, Host)).
formal(no_pin, Host, Request, existence_error(gpio_pin, Number)) :-
    number_of_pin(Host, Request, Number).
formal(in_use, Host, Request, permission_error(use, gpio_pin, Number)) :-
    number_of_pin(Host, Request, Number).
formal(direction, _, Request, permission_error(Do, pin, Name)) :-
    _{do:Do, pin:Name} :< Request.
formal(real, _, Request, permission_error(drive, pin, Name)) :-
    get_dict(pin, Request, Name).
formal(value, _, Request, domain_error(pin_value, Value)) :-
    get_dict(value, Request, Value).
formal(timeout, Host, Request, timeout_error(gpio(Name), Host)) :-
    get_dict(pin, Request, Name).

number_of_pin(Host, Request, Number) :-
    get_dict(pin, Request, Name),
    known_pin(Host, Name, _, Opening),
    get_dict(number, Opening, Number).

typhon_helper_owner:again(gpio(Host), Request) :-
    known_pin(Host, _, _, Request).

typhon_helper_owner:handle_message(gpio(Host), Dict) :-
    _{event:"edge", pin:Text, value:Value} :< Dict,
    is_value(input, Value),
    known_pin(Host, Name, input, _),
    atom_string(Name, Text),
    !,
    subscribers_notify(gpio, Host, Name, edge(Name, Value), edge(Name, _)).
typhon_helper_owner:handle_message(gpio(Host), Dict) :-
    _{event:"missing", pin:Pin, message:Text} :< Dict,
    print_message(warning, typhon(gpio_pin_missing(Host, Pin, Text))).

prolog:message(typhon(gpio_pin_missing(Host, Pin, Text))) -->
    [ 'GPIO on ~w: the pin ~w cannot be opened again: ~w'-[Host, Pin, Text] ].

%   is_value(+Kind, +Value): the helper may report Value.

is_value(thermometer, Value) =>
    number(Value),
    Value >= -273.15,
    Value =< 1000.
is_value(pwm, Value) =>
    number(Value),
    Value >= 0,
    Value =< 1.
is_value(_, Value) =>
    ( Value == 0 ; Value == 1 ).

                /*******************************
                *            AGENTS            *
                *******************************/

:- public                               % called by agents
    pin/2,
    pins/1,
    pin_watch/1,
    pin_watch/2,
    pin_unwatch/1,
    pin_open/2,
    pin_close/1,
    pin_drive/2.

%!  pin(+Name, ?Value) is semidet.
%
%   Set an output to Value, 0 or 1, or a PWM output to a part of the time from 0
%   to 1.  Otherwise, unify Value with that of the pin; that of a thermometer is
%   in degrees Celsius.
%
%   @error existence_error(pin, Name), domain_error(pin_value, Value),
%   gpio_error(silent, Host) if a thermometer does not answer,
%   gpio_error(failed, Host) if the device fails, those of gpio_start/3 if the
%   restarted helper could not open the pin again,
%   timeout_error(gpio(Name), Host), helper_died(Status, gpio(Host))

pin(Name, Value) :-
    the_pin(Name, Host, Kind),
    pin(Kind, Host, Name, Value).

pin(Kind, Host, Name, Value) :-
    nonvar(Value),
    memberchk(Kind, [output,pwm]),
    !,
    must_be(number, Value),
    ask(Host, _{do:write, pin:Name, value:Value}, _).
pin(Kind, Host, Name, Value) :-
    ask(Host, _{do:read, pin:Name}, Value0),
    (   is_value(Kind, Value0)
    ->  Value = Value0
    ;   throw(error(gpio_error(failed, Host), _))
    ).

%!  pins(-Pins:list) is det.
%
%   Pins are the pins of this host, Name=Kind, where Kind is `output`, `input`,
%   `pwm` or `thermometer`.

pins(Pins) :-
    subscriber(Host, _),
    findall(Name=Kind, known_pin(Host, Name, Kind, _), Pins0),
    Pins = Pins0.

%!  pin_watch(+Name) is det.
%!  pin_watch(+Name, +Options) is det.
%
%   The agent gets gpio-edge(Name, Value) when an input has changed, until it
%   calls pin_unwatch/1, leaves the host, or ends.  Messages that do not fit in
%   its queue are reported by gpio-dropped(Name, Count).  Options: as(How),
%   queue(N), as of subscribe/5 of typhon_subscribers.
%
%   @error existence_error(pin, Name), permission_error(watch, pin, Name)

pin_watch(Name) :-
    pin_watch(Name, []).

pin_watch(Name, Options) :-
    must_be(list, Options),
    the_pin(Name, Host, Kind),
    (   Kind == input
    ->  true
    ;   permission_error(watch, pin, Name)
    ),
    subscriber(Host, Agent),
    gpio_option(Host, queue(Max), 1000),
    append(Options, [queue(Max)], Options1),
    subscribe_to(gpio, Host, Name, Agent, Options1).

%!  pin_unwatch(+Name) is det.
%
%   End the pin_watch/1 of the agent.
%
%   @error existence_error(pin_watch, Name)

pin_unwatch(Name) :-
    subscriber(Host, Agent),
    must_be(atom, Name),
    (   unsubscribe_from(gpio, Host, Name, Agent)
    ->  true
    ;   existence_error(pin_watch, Name)
    ).

%!  pin_open(+Name, +Pin) is det.
%!  pin_close(+Name) is det.
%
%   Use another pin of the board, as of gpio_start/3; release it. Needs the option
%   open(true) of gpio_start/3.
%
%   @error permission_error(open, pin, Name), and errors of gpio_start/3

pin_open(Name, Pin) :-
    may_open(Host, Name),
    pin_request(Name=Pin, Request),
    open_pin(Host, Request).

pin_close(Name) :-
    may_open(Host, Name),
    the_pin(Name, Host, _),
    ask(Host, _{do:close, pin:Name}, _),
    retractall(known_pin(Host, Name, _, _)),
    subscribers_drop(gpio, Host, Name, closed(Name)).

may_open(Host, Name) :-
    subscriber(Host, _),
    gpio_option(Host, open(Open), false),
    (   Open == true
    ->  true
    ;   permission_error(open, pin, Name)
    ).

%!  pin_drive(+Name, +Value) is det.
%
%   On a simulated board: what is outside gives an input, or a thermometer, Value.
%
%   @error permission_error(drive, pin, Name) if the pin is real, or an output
%   @error domain_error(pin_value, Value)

pin_drive(Name, Value) :-
    the_pin(Name, Host, _),
    must_be(number, Value),
    ask(Host, _{do:drive, pin:Name, value:Value}, _).
