:- module(typhon_app_engine_options,
          [ engine_option/4,            % ?Option, ?Type, ?Meta, ?Help
            engine_options/3,           % +Program, +Options, -FleetOptions
            in_fleet/4                  % +Program, +Options, -Fleet, :Goal
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module('../../prolog/typhon', [fleet_join/2, fleet_leave/1]).
:- use_module(serving, [and_then/2]).
:- use_module(usage, []).

/** <module> The engine of a fleet on the command line

*Threading*: the main thread.
*/

:- meta_predicate in_fleet(+, +, -, 0).

%!  engine_option(?Option, ?Type, ?Meta, ?Help) is nondet.
%
%   The options that lead to the engine, see option/5 of commands.pl.

engine_option(redis, atom, 'HOST:PORT',
              'with --fleet: its engine, a server of Redis or Valkey').
engine_option(user, atom, 'NAME',
              'with --fleet: user of the engine').
engine_option(password_file, file(read), 'FILE',
              'with --fleet: password of the engine').
engine_option(cacert, file(read), 'FILE',
              'with --fleet: use TLS; certificate of the authority of the \c
               engine').
engine_option(cert, file(read), 'FILE',
              'with --cacert: certificate of this process').
engine_option(key, file(read), 'FILE',
              'with --cacert: private key of that certificate').

%!  engine_options(+Program, +Options:list, -FleetOptions:list) is det.
%
%   FleetOptions are those of fleet_join/2 if fleet(_) is among Options, which
%   were given to Program, else none.
%
%   @error typhon_usage(required(Program, Option)): one option needs another

engine_options(Program, Options, FleetOptions) :-
    (   option(fleet(_), Options)
    ->  needed(redis(_), Program, Options)
    ;   engine_option(Name, _, _, _),
        Option =.. [Name,_],
        option(Option, Options)
    ->  needed(fleet(_), Program, Options)
    ;   true
    ),
    findall(Option, for_engine(Program, Options, Option), FleetOptions).

needed(Option, _, Options) :-
    option(Option, Options),
    !.
needed(Option, Program, _) :-
    functor(Option, Name, _),
    throw(error(typhon_usage(required(Program, Name)), _)).

for_engine(Program, Options, redis(Host:Port)) :-
    option(redis(Text), Options),
    (   atomic_list_concat([Host,Text1], :, Text),
        Host \== '',
        atom_number(Text1, Port),
        integer(Port)
    ->  true
    ;   throw(error(typhon_usage(option(Program,
                                        value_type(redis, 'HOST:PORT', Text))),
                    _))
    ).
for_engine(_, Options, user(User)) :-
    option(user(User), Options).
for_engine(_, Options, password(Password)) :-
    option(password_file(File), Options),
    read_file_to_string(File, Text, []),
    split_string(Text, "\n", "\r", [Password|_]).
for_engine(_, Options, tls(true)) :-
    option(cacert(_), Options).
for_engine(_, Options, Option) :-
    member(Option, [cacert(_), cert(_), key(_)]),
    option(Option, Options).

%!  in_fleet(+Program, +Options:list, -Fleet, :Goal) is nondet.
%
%   Call Goal while this process is a member of Fleet, which is among Options.
%
%   @error typhon_usage(required(Program, Option)), errors of fleet_join/2

in_fleet(Program, Options, Fleet, Goal) :-
    needed(fleet(Fleet), Program, Options),
    engine_options(Program, Options, Engine),
    fleet_join(Fleet, Engine),
    and_then(Goal, fleet_leave(Fleet)).
