:- module(typhon_diagnose,
          [ diagnose/1,                 % +Address
            diagnose_steps/2,           % +Steps, :Check
            python_says/4               % +Python, +Code, +Module, -Text
          ]).

/** <module> Diagnosis of an unreachable host

Tests the connection to a host step by step, from this Prolog to an answer,
prints each result, and stops with advice at the step that fails.

*Threading*: the calling thread.  A TCP connect cannot be given a deadline,
so it runs in a thread of its own, which may block for a while after the result
has been printed if the network does not answer.
*/

:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(socket),
              [ tcp_close_socket/1, tcp_connect/2, tcp_host_to_address/2,
                tcp_socket/1
              ]).
:- use_module('../../prolog/typhon/kernel/base/monotonic',
              [monotonic_time/1, wait_within/2]).
:- use_module('../../prolog/typhon', [host_property/2]).
:- use_module('../../prolog/typhon/kernel/base/error_lines', [error_text/2]).
:- use_module('../../prolog/typhon/kernel/base/text', [format_shown/2]).
:- use_module('../../prolog/typhon/kernel/host/hosts', [address_parts/3]).
:- use_module('../../prolog/typhon/kernel/wire',
              [cookie/1, endpoint_parts/3, endpoint_peer/2]).

connect_deadline(5).                    % seconds

%!  diagnose(+Address) is semidet.
%
%   Prints the result of each step to the host Address, or with `none` of each
%   step that needs no host.  Fails at the first step that does not work.

diagnose(Address) :-
    findall(Step-Advice, step(Step, Advice), Steps),
    diagnose_steps(Steps, check(Address)).

%!  diagnose_steps(+Steps, :Check) is semidet.
%
%   Calls call(Check, Step, Found) for each of Steps, which are Step-Advice, and
%   prints Found, a text, or `not_asked`.  At the first step that raises an
%   error or fails, prints the advice and fails.

:- meta_predicate diagnose_steps(+, 2).

diagnose_steps([], _).
diagnose_steps([Step-Advice|Steps], Check) :-
    catch(once(call(Check, Step, Found)), error(Formal, Context), true),
    (   Found == not_asked
    ->  diagnose_steps(Steps, Check)
    ;   nonvar(Found)
    ->  format_shown('  ok    ~w~t~24|~w~n', [Step, Found]),
        diagnose_steps(Steps, Check)
    ;   format('  FAIL  ~w~t~24|', [Step]),
        error_text(error(Formal, Context), Text),
        format_shown('~w~n', [Text]),
        format('~t~24|~w~n', [Advice]),
        fail
    ).

%!  python_says(+Python, +Code, +Module, -Text:atom) is det.
%
%   Text is the line that Code prints, run by Python.
%
%   @error existence_error(python, Python), existence_error(python_module,
%   Module) if Code fails, for example because Module is missing

python_says(Python, Code, Module, Text) :-
    catch(process_create(Python, ['-c', Code],
                         [ stdout(pipe(Out)), stderr(null), process(Pid) ]),
          error(_, _),
          throw(error(existence_error(python, Python), _))),
    read_string(Out, _, Said),
    close(Out),
    process_wait(Pid, Status),
    (   Status == exit(0)
    ->  split_string(Said, "", "\n ", [Line]),
        atom_string(Text, Line)
    ;   throw(error(existence_error(python_module, Module), _))
    ).

%   step(Name, Advice)

step(prolog,
     'Install SWI-Prolog 9.0.4 or later, with thread support.').
step(cookie,
     'The cookie file must be yours alone: chmod 600, or delete it.').
step(address,
     'Write NAME@INTERFACE:PORT, as the host prints it when it starts.').
step('name resolution',
     'Use the IP address, or put the name into /etc/hosts.').
step(connection,
     'Is the host running, with --bind to an interface reachable from here?').
step(authentication,
     'Copy ~/.typhon.cookie so that both machines have the same one.').
step(host,
     'Start the host there, or use the name of a running one.').

%   check(Address, Step, Found): Found is the result, as text.

check(_, prolog, Found) :-
    current_prolog_flag(version, Version),
    (   Version >= 90004,
        current_prolog_flag(threads, true)
    ->  current_prolog_flag(address_bits, Bits),
        Major is Version//10000,
        Minor is Version//100 mod 100,
        Patch is Version mod 100,
        format(atom(Found), 'SWI-Prolog ~d.~d.~d, ~d bits',
               [Major, Minor, Patch, Bits])
    ;   throw(error(representation_error(prolog_version(Version)), _))
    ).
check(_, cookie, Found) :-
    cookie(_),
    cookie_source(Found).
check(none, _, not_asked) :-
    !.
check(Address, address, Found) :-
    located(Address, Name, Interface, Port),
    format(atom(Found), 'host ~w, port ~d of ~w', [Name, Port, Interface]).
check(Address, 'name resolution', Found) :-
    located(Address, _, Interface, _),
    resolve(Interface, IP),
    format(atom(Found), '~w is ~w', [Interface, IP]).
check(Address, connection, 'a program listens there') :-
    located(Address, _, Interface, Port),
    connect_within_deadline(Interface:Port).
check(Address, authentication, Found) :-
    monotonic_time(Start),
    catch(host_property(Address, state(_)),
          error(existence_error(host, _), _), true),  % the next step reports it
    monotonic_time(End),
    MilliSeconds is (End-Start)*1000,
    codec(Address, Codec),
    format(atom(Found), 'same cookie, codec ~w, answered in ~1f ms',
           [Codec, MilliSeconds]).
check(Address, host, Found) :-
    host_property(Address, state(Found)).

%   In 9.2, tcp_host_to_address/2 fails for many names; host_address/3 does not.

:- if(( module_property(socket, exports(List)),
        memberchk(host_address/3, List) )).
:- use_module(library(socket), [host_address/3]).
resolve(Interface, IP) :-
    host_address(Interface, Socket, []),
    get_dict(address, Socket, IP).
:- else.
resolve(Interface, IP) :-
    tcp_host_to_address(Interface, IP).
:- endif.

cookie_source('from the environment variable TYPHON_COOKIE') :-
    getenv('TYPHON_COOKIE', _),
    !.
cookie_source(File) :-
    getenv('TYPHON_COOKIE_FILE', File),
    !.
cookie_source('~/.typhon.cookie').

located(Address, Name, Interface, Port) :-
    (   address_parts(Address, Name, Endpoint),
        endpoint_parts(Endpoint, Interface, Port)
    ->  true
    ;   throw(error(domain_error(host_address, Address), _))
    ).

codec(Address, Codec) :-
    address_parts(Address, _, Endpoint),
    endpoint_peer(Endpoint, codec(Codec)),
    !.
codec(_, unknown).

                /*******************************
                *            CONNECT           *
                *******************************/

connect_within_deadline(Address) :-
    connect_deadline(Seconds),
    thread_self(Me),
    thread_create(try_connect(Address, Me), _, [detached(true)]),
    (   wait_within(Seconds, thread_get_message(Me, connected(Result)))
    ->  true
    ;   Result = error(timeout_error(connect, Address), _)
    ),
    (   Result == true
    ->  true
    ;   throw(Result)
    ).

try_connect(Address, Asker) :-
    catch(( tcp_socket(Socket),
            call_cleanup(tcp_connect(Socket, Address),
                         tcp_close_socket(Socket)),
            Result = true
          ),
          error(Formal, Context),
          Result = error(Formal, Context)),
    thread_send_message(Asker, connected(Result)).
