:- module(typhon_engine,
          [ engine_open/2,              % +Fleet, +Options
            engine_close/1,             % +Fleet
            engine/3,                   % +Fleet, +Command, -Reply
            engine_script/4,            % +Fleet, +Script, +Args, -Reply
            engine_run_id/2,            % +Fleet, -Id
            engine_key/3                % +Fleet, +Names, -Key
          ]).
:- use_module(library(apply), [include/3, maplist/2]).
:- use_module(library(error), [existence_error/2, permission_error/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2, memberchk/2, nth1/3]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(redis),
              [redis/3, redis_connect/3, redis_disconnect/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(library(sha), [hash_atom/2, sha_hash/3]).
:- use_module('../../kernel/base/monotonic',
              [deadline/2, monotonic_time/1, wait_within/2]).
:- use_module(modelled,
              [ modelled/1, modelled_call/4, modelled_close/1,
                modelled_open/1 ]).

/** <module> The engine of a fleet: a server of Redis

library(redis) as fleets need it: every call ends in time, with an answer or an
error.  That library waits for ever for a server that is suspended, so a thread
of its own connects, and streams have a limit.  It also repeats commands after
errors; here only scripts and questions are repeated, which decide by what is
stored.  Texts in answers are strings: "007" would be 7 otherwise.

What an engine decides in one step is a script in Lua, `scripts/NAME.lua`, after
`scripts/head.lua`.  Its first argument is the prefix of all keys of the fleet,
whose braces keep them on one node of a cluster.

*Threading*: any thread.  A connection that no call uses waits in the queue of
its fleet.
*/

:- multifile prolog:error_message//1.

:- setting(typhon_fleet:engine_seconds, number, 2,
           "Seconds after which an engine that does not answer counts as down").
:- setting(typhon_fleet:engine_pause, number, 0.5,
           "Seconds for which an engine that is down is not asked again").

:- dynamic
    server/3,                   % Fleet, Idle, Options
    down/3,                     % Fleet, Until, Why
    text/3.                     % Script, Sha, Text

                /*******************************
                *         CONNECTIONS          *
                *******************************/

%!  engine_open(+Fleet, +Options) is det.
%!  engine_close(+Fleet) is det.
%
%   Options: redis(Host:Port), or sentinel(Name) and sentinels(Addresses), or
%   engine(modelled), see typhon_modelled_engine;
%   user(User), password(Password), tls(true), cacert(File), key(File),
%   cert(File).
%
%   @error resource_error(fleet(Fleet)): the engine does not answer
%   @error permission_error(authenticate, fleet, Fleet)
%   @error existence_error(option, Option): TLS needs three files

engine_open(Fleet, Options) :-
    option(engine(modelled), Options),
    !,
    modelled_open(Fleet).
engine_open(Fleet, Options) :-
    (   option(tls(true), Options),
        member(Option, [cacert(_), key(_), cert(_)]),
        \+ option(Option, Options)
    ->  functor(Option, Name, _),
        existence_error(option, Name)
    ;   true
    ),
    message_queue_create(Idle),
    assertz(server(Fleet, Idle, Options)),
    catch(engine(Fleet, ping, _), Ball,
          ( engine_close(Fleet), throw(Ball) )).

engine_close(Fleet) :-
    modelled(Fleet),
    !,
    modelled_close(Fleet).
engine_close(Fleet) :-
    (   retract(server(Fleet, Idle, _))
    ->  close_idle(Idle),
        message_queue_destroy(Idle),
        retractall(down(Fleet, _, _))
    ;   true
    ).

close_idle(Idle) :-
    (   thread_get_message(Idle, connection(C), [timeout(0)])
    ->  disconnect(C),
        close_idle(Idle)
    ;   true
    ).

disconnect(C) :-
    catch(redis_disconnect(C, [force(true)]), error(_, _), true).

%   taken(+Fleet, -Got, -Age): connection(C), `old` if it was used before, or
%   failed(Why).  If none is idle a thread makes one, and is interrupted after a while: the system may
%   take minutes to report that a machine is not there.  At most three do so at a
%   time, since the search for a name is not interrupted.

taken(Fleet, Got, Age) :-
    (   server(Fleet, Idle, Options)
    ->  true
    ;   existence_error(fleet, Fleet)
    ),
    is_up(Fleet),
    (   Got = connection(_),
        thread_get_message(Idle, Got, [timeout(0)])
    ->  Age = old,
        arg(1, Got, C),
        ignore(limit(C))                % the setting may have changed
    ;   Age = new,
        connect_in_thread(Fleet, Idle, Options),
        setting(typhon_fleet:engine_seconds, Seconds),
        (   wait_within(Seconds, thread_get_message(Idle, Got))
        ->  true
        ;   forall(connecting(Fleet, Alias), interrupt(Alias)),
            goes_down(Fleet, 'it does not answer')
        )
    ).

is_up(Fleet) :-
    (   down(Fleet, Until, Why),
        monotonic_time(Now),
        Now < Until
    ->  unreachable(Fleet, Why)
    ;   true
    ).

failed(refused(Text), Fleet) :-
    throw(error(permission_error(authenticate, fleet, Fleet), context(_, Text))).
failed(down(Why), Fleet) :-
    goes_down(Fleet, Why).

goes_down(Fleet, Why) :-
    setting(typhon_fleet:engine_pause, Pause),
    deadline(Pause, Until),
    retractall(down(Fleet, _, _)),
    assertz(down(Fleet, Until, Why)),
    unreachable(Fleet, Why).

unreachable(Fleet, Why) :-
    throw(error(resource_error(fleet(Fleet)), context(_, Why))).

connect_in_thread(Fleet, Idle, Options) :-
    ignore(( connecting(Fleet, Alias),
             started(Alias, connect_for(Idle, Options)) )).

connecting(Fleet, Alias) :-
    between(1, 3, N),
    atomic_list_concat([typhon_engine, Fleet, N], '_', Alias).

%   started(+Alias, +Goal): fails if there is a thread Alias.

started(Alias, Goal) :-
    catch(thread_create(typhon_engine:Goal, _, [alias(Alias), detached(true)]),
          error(permission_error(create, thread, _), _), fail).

interrupt(Thread) :-
    catch(thread_signal(Thread, throw(error(timeout_error(connect, engine), _))),
          error(_, _), true).

connect_for(Idle, Options) :-
    catch(ignore(connects(Idle, Options)),
          error(timeout_error(connect, engine), _), true).

connects(Idle, Options) :-
    catch(( connected(Options, C), Result = connection(C) ),
          error(Formal, _),
          ( Formal \= timeout_error(connect, engine),
            why(Formal, Why),
            Result = failed(Why) )),
    catch(thread_send_message(Idle, Result), error(existence_error(_, _), _),
          ( Result = connection(Late) -> disconnect(Late) ; true )).

%   Without nodelay the last write of a command above 4 kB waits until the engine
%   has acknowledged the others.

connected(Options, C) :-
    address(Options, Address),
    include(is_tls, Options, Tls),
    redis_connect(Address, C, [reconnect(false), nodelay(true)|Tls]),
    catch(greeted(C, Options), Ball, ( disconnect(C), throw(Ball) )).

is_tls(Option) :-
    functor(Option, Name, 1),
    memberchk(Name, [tls, cacert, key, cert]).

%   redis_connect/3 would greet before a limit can be set, and gives a password
%   only with a user.

greeted(C, Options) :-
    limit(C),
    (   option(password(Password), Options)
    ->  option(user(User), Options, default),
        redis(C, hello(3, auth, User, Password), _)
    ;   redis(C, hello(3), _)
    ).

limit(C) :-
    is_open(C, Stream),
    setting(typhon_fleet:engine_seconds, Seconds),
    set_stream(Stream, timeout(Seconds)).

address(Options, Address) :-
    option(redis(Address), Options),
    !.
address(Options, Address) :-
    option(sentinel(Pool), Options),
    option(sentinels(Sentinels), Options, []),
    setup_call_cleanup(
        ask_all(Sentinels, Pool, Answers, Threads),
        answer_of_one(Threads, Answers, Address),
        ( message_queue_destroy(Answers), maplist(interrupt, Threads) )).

%   All sentinels are asked at once: the machine of the first may be gone.

ask_all(Sentinels, Pool, Answers, Threads) :-
    message_queue_create(Answers),
    thread_self(Self),
    findall(Alias,
            ( nth1(N, Sentinels, Sentinel),
              atomic_list_concat([Self, N], '_', Alias),
              started(Alias, ask(Sentinel, Pool, Answers)) ),
            Threads).

ask(Sentinel, Pool, Answers) :-
    catch(( catch(master(Sentinel, Pool, Address), error(Formal, _), true),
            thread_send_message(Answers, answer(Formal, Address)) ),
          error(_, _), true).

answer_of_one([], _, _) :-
    throw(error(existence_error(sentinel, any), _)).
answer_of_one([_|Threads], Answers, Address) :-
    thread_get_message(Answers, answer(Formal, Address0)),
    (   var(Formal)
    ->  Address = Address0
    ;   answer_of_one(Threads, Answers, Address)
    ).

master(Sentinel, Pool, Host:Port) :-
    redis_connect(Sentinel, C, [reconnect(false)]),
    call_cleanup(( limit(C),
                   redis(C, sentinel('get-master-addr-by-name', Pool),
                         [Host0, Port0] as string) ),
                 disconnect(C)),
    atom_string(Host, Host0),
    number_string(Port, Port0).

                /*******************************
                *             CALLS            *
                *******************************/

%!  engine(+Fleet, +Command, -Reply) is semidet.
%
%   Reply has strings, numbers, lists and pairs.  Fails if it is nil.  After an
%   error it is not known whether the engine has executed Command.
%
%   @error existence_error(fleet, Fleet), resource_error(fleet(Fleet))
%   @error resource_error(fleet_space(Fleet)): the engine has no space left
%   @error redis_error(Code, Text): Command is wrong

engine(Fleet, Command, _) :-
    modelled(Fleet),
    !,
    functor(Command, Name, _),
    permission_error(model, engine_command, Name).
engine(Fleet, Command, Reply) :-
    attempt(first, Fleet, Command, Reply).

attempt(Attempt, Fleet, Command, Reply) :-
    taken(Fleet, Got, Age),
    tried(Got, Fleet, Command, Answer),
    answer(Answer, Age-Attempt, Fleet, Command, Reply).

tried(connection(C), Fleet, Command, Answer) :-
    call_cleanup(asked(C, Command, Answer), give_back(Answer, Fleet, C)).
tried(failed(Why), _, _, stale(Why)).

asked(C, Command, Answer) :-
    catch(( redis(C, Command, Reply as string)
          -> Answer = reply(Reply)
          ;  Answer = nil ),
          error(Formal, _),
          answer_of(Formal, Answer)).

answer_of(redis_error(Code, Text), Answer) :-
    !,
    (   means_down(Code)
    ->  Answer = broken(down(Text))
    ;   means_refused(Code, Text)
    ->  Answer = broken(refused(Text))
    ;   means_full(Code)
    ->  Answer = full(Text)
    ;   Answer = error(redis_error(Code, Text))
    ).
answer_of(timeout_error(_, _), broken(down('it does not answer'))) :-
    !.
answer_of(Formal, stale(Why)) :-
    why(Formal, Why).

means_down(Code) :-
    memberchk(Code, [ loading, readonly, masterdown, busy, clusterdown, tryagain,
                      noreplicas ]).

means_full(Code) :-
    memberchk(Code, [misconf, oom]).

means_refused(Code, _) :-
    memberchk(Code, [wrongpass, noauth, noperm]).
means_refused(err, Text) :-             % of a script
    sub_string(Text, 0, _, _, "The user executing the script can't").

why(redis_error(Code, Text), refused(Text)) :-
    means_refused(Code, Text),
    !.
why(redis_error(_, Text), down(Text)) :-
    !.
why(Formal, down(Why)) :-
    format(atom(Why), '~p', [Formal]).

%   After an error the library may have closed C; used again it would connect anew
%   by itself, without a limit and without the password.

is_open(C, Stream) :-
    arg(_, C, Stream),
    is_stream(Stream),
    !.

give_back(Answer, Fleet, C) :-
    (   nonvar(Answer),
        \+ functor(Answer, broken, 1),
        \+ functor(Answer, stale, 1),
        is_open(C, _),
        server(Fleet, Idle, _),
        catch(thread_send_message(Idle, connection(C)), error(_, _), fail)
    ->  true
    ;   disconnect(C)
    ).

%   A connection that breaks when it is used again is older than the engine; a new
%   one may have been cut by chance, but not the next one, too.

answer(reply(Reply), _, _, _, Reply).
answer(error(Formal), _, _, _, _) :-
    throw(error(Formal, _)).
answer(full(Text), _, Fleet, _, _) :-
    throw(error(resource_error(fleet_space(Fleet)), context(_, Text))).
answer(stale(_), old-Attempt, Fleet, Command, Reply) :-
    !,
    ignore(( server(Fleet, Idle, _), close_idle(Idle) )),
    attempt(Attempt, Fleet, Command, Reply).
answer(stale(down(_)), new-first, Fleet, Command, Reply) :-
    !,
    attempt(again, Fleet, Command, Reply).
answer(stale(Why), _, Fleet, _, _) :-
    failed(Why, Fleet).
answer(broken(Why), _, Fleet, _, _) :-
    failed(Why, Fleet).

%!  engine_script(+Fleet, +Script:atom, +Args:list, -Reply) is semidet.
%
%   Call `scripts/Script.lua` with the prefix of the keys of Fleet and Args, in
%   one step of the engine.  It may be called twice.

engine_script(Fleet, Script, Args, Reply) :-
    modelled(Fleet),
    !,
    modelled_call(Fleet, Script, Args, Reply).
engine_script(Fleet, Script, Args, Reply) :-
    script(Script, Sha, Text),
    engine_key(Fleet, [''], Prefix),
    ByHash =.. [evalsha, Sha, 0, Prefix|Args],
    catch(( engine(Fleet, ByHash, Reply0) -> Found = true ; Found = false ),
          error(redis_error(noscript, _), _),
          Found = new),
    (   Found == new
    ->  Whole =.. [eval, Text, 0, Prefix|Args],
        engine(Fleet, Whole, Reply)
    ;   Found == true,
        Reply = Reply0
    ).

script(Script, Sha, Text) :-
    text(Script, Sha, Text),
    !.
script(Script, Sha, Text) :-
    lua(head, Head),
    lua(Script, Body),
    string_concat(Head, Body, Text),
    sha_hash(Text, Hash, [encoding(utf8)]),
    hash_atom(Hash, Sha),
    assertz(text(Script, Sha, Text)).

lua(Script, Text) :-
    module_property(typhon_engine, file(Here)),
    file_directory_name(Here, Directory),
    format(atom(Relative), 'scripts/~w.lua', [Script]),
    directory_file_path(Directory, Relative, File),
    read_file_to_string(File, Text, [encoding(utf8)]).

%!  engine_run_id(+Fleet, -Id:atom) is det.
%
%   Id changes when the engine is started again.

engine_run_id(Fleet, Id) :-
    modelled(Fleet),
    !,
    Id = modelled.
engine_run_id(Fleet, Id) :-
    engine(Fleet, info(server), Text),
    split_string(Text, "\n", "\r ", Lines),
    member(Line, Lines),
    string_concat("run_id:", Id0, Line),
    !,
    atom_string(Id, Id0).

%!  engine_key(+Fleet, +Names:list, -Key:atom) is det.

engine_key(Fleet, Names, Key) :-
    atomic_list_concat(['f:{', Fleet, '}'], Prefix),
    atomic_list_concat([Prefix|Names], :, Key).

                /*******************************
                *            MESSAGES          *
                *******************************/

prolog:error_message(resource_error(fleet(Fleet))) -->
    { server(Fleet, _, Options),
      ( option(redis(At), Options) ; option(sentinel(At), Options) ),
      !
    },
    [ 'The engine of the fleet ~w, Redis at ~w, cannot be reached'-
      [Fleet, At] ].
prolog:error_message(resource_error(fleet(Fleet))) -->
    [ 'The engine of the fleet ~w cannot be reached'-[Fleet] ].
prolog:error_message(resource_error(fleet_space(Fleet))) -->
    [ 'The engine of the fleet ~w has no space left'-[Fleet] ].
prolog:error_message(permission_error(model, engine_command, Command)) -->
    [ 'A modelled engine has no ~w: journals, watches and queues of work need \c
       a server'-[Command] ].
prolog:error_message(permission_error(authenticate, fleet, Fleet)) -->
    [ 'The engine of the fleet ~w does not accept the user and password: \c
       check user(User) and password(Password), and its ACL'-[Fleet] ].
