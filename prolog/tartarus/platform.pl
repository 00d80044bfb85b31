:- module(tartarus_platform,
          [ start_tartarus/1,           % +Port
            start_tartarus/2,           % +A, +B
            start_tartarus/3,           % +Ip, +Port, +Token
            platform_start/2,           % +Ip, +Port
            close_tartarus/0,
            reset_tartarus/0,
            get_tartarus_details/2,     % -Ip, -Port
            set_token/1,                % +Token
            print_tartarus_status/0,
            assert_file_to_tartarus/1,  % +File
            verbose/1,                  % +Bit
            nothing/0,
            here/1,                     % -Location
            location_address/2,         % +Location, -Address
            same_location/2,            % +Location, +Location
            port_open/2,                % +Port, -Key
            port_closed/1,              % +Key
            print_lines/2,              % +Format, +Arguments
            verbosely/2,                % +Format, +Arguments
            verbosity/1,                % ?Bit
            print_problem/2,            % +Format, +Arguments
            must/1                      % :Checks
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [member/2]).
:- use_module('../typhon', [host_change/2, host_start/2, host_stop/1]).
:- use_module('../typhon/kernel/base/error_text', [print_error/2]).
:- use_module('../typhon/kernel/base/text', [format_shown/3, formatted/3]).

/** <module> Platforms

A platform is identified by a pair (Ip,Port), as its user wrote it.  It is a
host called `tartarus`, whose place is module `user`.  The carriers of agents
that leave are created on a second host, `tartarus_gate`, which asks for no
token.

*Threading*: any thread; one mutex.
*/

:- multifile
    closing/0,                          % remove agents and their resources
    status/0.                           % print a section of the status
:- dynamic
    closing/0,
    status/0,
    asserted/1.                         % Clause reference, from a file

:- dynamic                              % programs look at these
    user:platform_Ip/1,
    user:platform_port/1,
    user:platform_token/1.

%!  start_tartarus(+Ip, +Port, +Token) is semidet.
%!  start_tartarus(+Port, +Token) is semidet.
%!  start_tartarus(+Ip, +Port) is semidet.
%!  start_tartarus(+Port) is semidet.
%!  platform_start(+Ip, +Port) is semidet.
%
%   Start the platform of this process, and print its banner.  Without a token
%   no agent is admitted.  Fails if the port is in use.  Ports above 65535 are
%   reduced modulo 65536.

start_tartarus(Port) :-
    platform_start(localhost, Port).

start_tartarus(Ip, Port) :-
    atom(Ip),
    !,
    platform_start(Ip, Port).
start_tartarus(Port, Token) :-
    start_tartarus(localhost, Port, Token).

start_tartarus(Ip, Port, Token) :-
    must([ check(t1, 'the port is an integer', integer(Port)),
           check(t2, 'the token is an integer', integer(Token)) ]),
    started(Ip, Port, 0),
    set_token(Token).

platform_start(Ip, Port) :-
    must([check(t1, 'the port is an integer', integer(Port))]),
    started(Ip, Port, 1).

started(Ip, Port, Verbosity) :-
    with_mutex(tartarus_platform, start(Ip, Port, Verbosity)).

start(_, _, _) :-
    here(_),
    !,
    print_lines("~n            Platform already created~n", []).
start(Ip, Port, Verbosity) :-
    catch(open_platform(Ip, Port), error(Formal, _),
          ( print_problem('The platform cannot be started at ~w, port ~w: ~p',
                          [Ip, Port, Formal]),
            fail )),
    set_verbosity(Verbosity),
    set_stream(user_output, buffer(line)),      % also for threads
    assertz(user:platform_Ip(Ip)),
    assertz(user:platform_port(Port)),
    format(atom(Line), '~`=t~48|', []),
    print_lines("~w~n  Tartarus, on Typhon~n  IP = ~w, Port = ~w~n~w~n",
                [Line, Ip, Port, Line]).

open_platform(Ip, Port0) :-
    Port is Port0 mod 65536,
    interface(Ip, Interface),
    first_tokens(Tokens),
    host_start(tartarus, [ port(Port), bind(Interface), place(user),
                           tokens(Tokens) ]),
    catch(host_start(tartarus_gate, []), Ball,
          ( host_stop(tartarus), throw(Ball) )).

first_tokens([Token]) :-
    (   user:platform_token(Token)
    ->  true
    ;   Token = '$tartarus_no_token'
    ).

%!  close_tartarus is semidet.
%
%   Stop the platform.  Threads of handlers continue.

close_tartarus :-
    with_mutex(tartarus_platform, close),
    print_lines("Platform has been closed.~n", []).

close :-
    here(_),
    !,
    forall(closing, true),
    host_stop(tartarus_gate),
    host_stop(tartarus),
    retractall(user:platform_Ip(_)),
    retractall(user:platform_port(_)).
close :-
    print_problem('There is no platform in this process', []),
    fail.

%!  reset_tartarus is semidet.
%
%   Remove agents and asserted files; the platform continues at the same port.

reset_tartarus :-
    here(_),
    !,
    forall(closing, true),
    print_lines("-------platform restarted sucessfully-------~n", []).
reset_tartarus :-
    print_problem('There is no platform in this process', []),
    fail.

%!  get_tartarus_details(-Ip, -Port) is semidet.

get_tartarus_details(Ip, Port) :-
    must([ check(d1, 'the first argument is unbound', var(Ip)),
           check(d2, 'the second argument is unbound', var(Port)) ]),
    here((Ip,Port)).

%!  set_token(+Token) is det.
%
%   Agents must show this token from now on.

set_token(Token) :-
    retractall(user:platform_token(_)),
    assertz(user:platform_token(Token)),
    (   here(_)
    ->  host_change(tartarus, tokens([Token]))
    ;   true
    ).

%!  verbose(+Bit) is det.
%
%   Print arrivals, creations and hop times if Bit is 1, and not if it is 0.

verbose(Bit) :-
    must([check(v1, 'the argument is 0 or 1', memberchk(Bit, [0,1]))]),
    set_verbosity(Bit).

%!  nothing is det.

nothing.

%!  print_tartarus_status is det.

print_tartarus_status :-
    (   here((Ip,Port))
    ->  print_lines("platform_Ip : ~w    platform_port : ~w~n", [Ip, Port])
    ;   print_lines("no platform~n", [])
    ),
    forall(status, true),
    print_lines("platform_token:~n", []),
    forall(user:platform_token(Token), print_lines("~w~n", [Token])).

%!  assert_file_to_tartarus(+File) is semidet.
%
%   Assert the clauses of File into `user`, as dynamic predicates.

assert_file_to_tartarus(File) :-
    must([check(f1, 'the file exists', exists_source_file(File))]),
    absolute_file_name(File, Path, [file_type(prolog), access(read)]),
    setup_call_cleanup(
        open(Path, read, In, [encoding(utf8)]),
        assert_all(In),
        close(In)).

exists_source_file(File) :-
    ground(File),
    absolute_file_name(File, _, [ file_type(prolog), access(read),
                                  file_errors(fail) ]).

assert_all(In) :-
    repeat,
    read_term(In, Term, [module(user)]),
    (   Term == end_of_file
    ->  !
    ;   assert_term(Term),
        fail
    ).

assert_term((:-Directive)) :-
    !,
    ignore(catch(user:Directive, Error,
                 print_error(warning, Error))).
assert_term(Clause) :-
    assertz(user:Clause, Ref),
    assertz(asserted(Ref)).

closing :-
    forall(retract(asserted(Ref)),
           catch(erase(Ref), error(existence_error(_, _), _), true)).

%!  here(-Location) is semidet.
%
%   Location, (Ip,Port), is that of the platform of this process.

here((Ip,Port)) :-
    user:platform_Ip(Ip),
    user:platform_port(Port),
    !.

%!  location_address(+Location, -Address) is det.
%
%   Address is the address of the host of the platform at Location.

location_address((Ip,Port0), Address) :-
    interface(Ip, Interface),
    Port is Port0 mod 65536,
    format(atom(Address), 'tartarus@~w:~d', [Interface, Port]).

interface(Ip, Interface) :-
    (   memberchk(Ip, [localhost, 'localhost.localdomain'])
    ->  Interface = '127.0.0.1'
    ;   Interface = Ip
    ).

%!  same_location(+Location1, +Location2) is semidet.

same_location(Location1, Location2) :-
    location_address(Location1, Address),
    location_address(Location2, Address).

%!  port_open(+Port, -Key) is det.
%!  port_closed(+Key) is det.
%
%   Make this process listen at a further Port; close that port.

port_open(Port0, Key) :-
    Port is Port0 mod 65536,
    atom_concat(tartarus_port_, Port, Key),
    host_start(Key, [port(Port)]).

port_closed(Key) :-
    host_stop(Key).

                /*******************************
                *           PRINTING           *
                *******************************/

:- meta_predicate must(:).

:- dynamic verbosity/1.

verbosity(0).

%!  print_lines(+Format, +Arguments) is det.
%!  verbosely(+Format, +Arguments) is det.
%
%   Print lines as format/2 does; verbosely/2 only if the platform is verbose.

print_lines(Format, Arguments) :-
    format_shown(user_output, Format, Arguments),
    flush_output(user_output).

verbosely(Format, Arguments) :-
    (   verbosity(1)
    ->  print_lines(Format, Arguments)
    ;   true
    ).

%!  verbosity(?Bit) is semidet.
%!  set_verbosity(+Bit) is det.
%
%   Bit is 1 if the platform is verbose, else 0.

set_verbosity(Bit) :-
    retractall(verbosity(_)),
    assertz(verbosity(Bit)).

%!  print_problem(+Format, +Arguments) is det.
%
%   Print an error on the standard error.

print_problem(Format, Arguments) :-
    formatted(Format, Arguments, Text),
    print_message(error, format('~s', [Text])).

%!  must(:Checks) is det.
%
%   Checks is a list of check(Code, Text, Goal).  Those whose Goal fails are
%   printed, and then the calling thread is aborted.

must(Module:Checks) :-
    findall(Code-Text,
            ( member(check(Code, Text, Goal), Checks), \+ Module:Goal ),
            Errors),
    (   Errors == []
    ->  true
    ;   maplist(print_check, Errors),
        length(Errors, Count),
        print_lines("errors found: ~d~n", [Count]),
        abort
    ).

print_check(Code-Text) :-
    print_lines("Error# ~w: ~w~n", [Code, Text]).
