:- module(fuzz_run,
          [ fuzz/2                      % +Options, -Faults
          ]).

/** <module> Malformed input for a host, and its effects

Most inputs come from unauthenticated clients, one in eight from a faulty peer
that has the cookie; another process requests a service of the victim now and
then. If the victim has keys, half of the clients do not speak TLS, some have
a self-signed certificate, and the others, as the peers, have one of the
authority.

At the end the process must be alive and serve; no unauthenticated client may
have been accepted; and no slot, session, request, agent, thread or queue may
be left.

Not tested: a damaged record with a valid checksum, which kills the process.
Only a peer with the cookie can send it.

*Threading*: the main thread.
*/

:- use_module('../lib/authority').
:- use_module('../lib/common').
:- use_module('../lib/peers').
:- use_module(fuzz_inputs).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2, nth1/3]).
:- use_module(library(option), [option/3]).
:- use_module(library(random), [random_between/3, random_member/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(socket)).
:- autoload(library(ssl),
            [cert_accept_any/5, ssl_context/3, ssl_negotiate/5]).
:- use_module(library(typhon/kernel/wire/handshake),
              [authenticate/6, hello/4]).
:- use_module(library(typhon/kernel/wire),
              [cookie/1, line_read/3, line_write/2]).
:- use_module(library(typhon/kernel/wire/frame), [frame_write/3, term_bytes/3]).

%!  fuzz(+Options, -Faults:list) is det.
%
%   Options: count(N), seed(N), progress(Bool), tls(Bool). Input I has the seed I
%   of its own; a fault names the seeds between which it was seen.

fuzz(Options, Faults) :-
    option(count(Count), Options, 2000),
    option(seed(Seed), Options, 1),
    option(progress(Progress), Options, false),
    option(tls(Tls), Options, false),
    (   Tls == true
    ->  with_authority([victim, fuzz, alien], [],
                       fuzz_with_keys(Count, Seed, Progress, Faults))
    ;   fuzz(plain, victim, honest, Count, Seed, Progress, Faults)
    ).

fuzz_with_keys(Count, Seed, Progress, Faults, Authority) :-
    self_made_host(Authority, alien),
    maplist(keys(Authority), [victim, fuzz, alien],
            [Victim, Fuzz, Alien]),
    maplist(context, [Fuzz, Alien], [Known, Unknown]),
    fuzz(tls(Known, Unknown), victim-[host([tls(Victim)])],
         honest-[host([tls(Victim)])], Count, Seed, Progress, Faults).

keys(Authority, Name, Dir) :-
    directory_file_path(Authority, Name, Dir).

context(Dir, Context) :-
    maplist(file_in(Dir), ['cert.pem', 'key.pem', 'ca.pem'],
            [Certificate, Key, Authority]),
    ssl_context(client, Context,
                [ certificate_file(Certificate), key_file(Key),
                  cacerts([file(Authority)]),
                  cert_verify_hook(cert_accept_any), close_parent(true) ]).

file_in(Dir, Name, File) :-
    directory_file_path(Dir, Name, File).

fuzz(Ways, Victim, Honest, Count, Seed, Progress, Faults) :-
    nb_setval(fuzz_ways, Ways),
    with_peers([Victim, Honest],
               ( attack(Count, Seed, Progress, Faults),
                 print_output(Faults) )).

%   The last output of the victim is added to faults.

print_output([]) :-
    !.
print_output(_) :-
    peer_messages(victim, Lines),
    length(Lines, Count),
    Skip is max(0, Count-20),
    forall(( nth1(I, Lines, Line), I > Skip ),
           format(user_error, 'victim: ~s~n', [Line])).

attack(Count, Seed, Progress, Faults) :-
    peer_host(victim, Host),
    atomic_list_concat([_, PortText], ':', Host),
    atom_number(PortText, Port),
    served(Host),
    gives_up_soon,
    footprint(Before),
    memory(M0),
    Last is Seed+Count-1,
    batches(Seed, Last, Port, Host, Progress, Faults0, M0),
    (   Faults0 == []
    ->  aftermath(Before, Faults)
    ;   Faults = Faults0
    ).

%   Messages to invented addresses are retried for a while.

gives_up_soon :-
    peer_do(victim, set_setting(typhon_news:news_seconds, 2)).

%   Checks the victim after each hundred inputs, up to the first fault.

batches(From, Last, _, _, _, [], _) :-
    From > Last,
    !.
batches(From, Last, Port, Host, Progress, Faults, Memory) :-
    To is min(Last, From+99),
    catch(( forall(between(From, To, Seed), input(Seed, Port)),
            check(served(Host), not_served),
            check(nobody_in, somebody_got_in),
            check(small(Memory), grows) ),
          error(Formal, _),
          true),
    (   nonvar(Formal)
    ->  Faults = [fault(Formal, seeds(From, To))]
    ;   progress(Progress, To),
        Next is To+1,
        batches(Next, Last, Port, Host, Progress, Faults, Memory)
    ).

progress(true, To) :-
    (To+1) mod 5000 < 100,
    !,
    memory(Memory),
    format('% seed ~d, ~d kB~n', [To, Memory]),
    flush_output.
progress(_, _).

:- meta_predicate check(0, +).

check(Goal, Fault) :-
    (   call(Goal)
    ->  true
    ;   throw(error(Fault, _))
    ).

		 /*******************************
		 *            INPUTS            *
		 *******************************/

%   One in eight is from a peer.

input(Seed, Port) :-
    set_random(seed(Seed)),
    random_between(1, 8, N),
    (   N == 1
    ->  peer(Seed, Port)
    ;   client_input(send(Codes, End)),
        catch(unauthenticated_client(Port, Codes, End), error(_, _), true)
    ).

:- dynamic lingering/2.                 % In, Out

unauthenticated_client(Port, Codes, End) :-
    client_transport(Way),
    connect(Way, Port, In, Out),
    catch(say(End, Codes, Out), error(_, _), true),
    (   End == close
    ->  close_streams(In, Out)
    ;   assertz(lingering(In, Out)),
        linger_no_more(40)
    ).

say(drip, Codes, Out) :-
    !,
    forall(member(Code, Codes),
           ( put_byte(Out, Code), flush_output(Out) )).
say(_, Codes, Out) :-
    maplist(put_byte(Out), Codes),
    flush_output(Out).

linger_no_more(Most) :-
    predicate_property(lingering(_, _), number_of_clauses(Count)),
    Count > Most,
    !,
    once(retract(lingering(In, Out))),
    close_streams(In, Out),
    linger_no_more(Most).
linger_no_more(_).

client_transport(Way) :-
    nb_getval(fuzz_ways, Ways),
    random_between(1, 10, N),
    client_transport(Ways, N, Way).

client_transport(tls(_, Unknown), 1, tls(Unknown)) :- !.
client_transport(tls(Known, _), N, tls(Known)) :- N =< 5, !.
client_transport(_, _, plain).

peer_way(Way) :-
    nb_getval(fuzz_ways, Ways),
    ( Ways = tls(Known, _) -> Way = tls(Known) ; Way = plain ).

connect(plain, Port, In, Out) :-
    connect(Port, In, Out).
connect(tls(Context), Port, In, Out) :-
    connect(Port, In0, Out0),
    catch(ssl_negotiate(Context, In0, Out0, In, Out), error(Formal, _),
          ( close_streams(In0, Out0), throw(error(Formal, _)) )),
    set_stream(In, encoding(octet)),
    set_stream(Out, encoding(octet)),
    set_stream(In, timeout(10)).

welcome(plain, _).
welcome(tls(_), In) :-
    hear_line(In).

connect(Port, In, Out) :-
    tcp_socket(Socket),
    catch(tcp_connect(Socket, '127.0.0.1':Port), Error,
          ( tcp_close_socket(Socket), throw(Error) )),
    tcp_open_socket(Socket, In, Out),
    set_stream(In, encoding(octet)),
    set_stream(Out, encoding(octet)),
    set_stream(In, timeout(10)).

close_streams(In, Out) :-
    close(Out, [force(true)]),
    close(In, [force(true)]).

%   A peer sends its malformed frames over one connection, and goodbye over
%   another, after which the victim should have no state of it.

peer(Seed, Port) :-
    format(atom(Process), 'fuzz~d', [Seed]),
    peer_codec(Speaks),
    hello(Process, 1, '127.0.0.1:1', Hello),
    (   Speaks == text
    ->  setarg(6, Hello, none)
    ;   true
    ),
    peer_frames(Speaks, Frames),
    try(3, with_session(Port, Hello, say_frames(Frames))),
    try(3, with_session(Port, Hello, goodbye(Speaks))).

%   The victim decodes records only of peers with its own certificate.

peer_codec(Codec) :-
    random_member(Codec0, [fast, text]),
    peer_way(Way),
    ( Way == plain -> Codec = Codec0 ; Codec = text ).

%   On a busy machine a handshake may take too long.

:- meta_predicate try(+, 0).

try(Times, Goal) :-
    catch(Goal, error(Formal, Context), true),
    (   var(Formal)
    ->  true
    ;   Times > 1
    ->  Times1 is Times-1,
        try(Times1, Goal)
    ;   throw(error(Formal, Context))
    ).

:- meta_predicate with_session(+, +, 2).

with_session(Port, Hello, Goal) :-
    peer_way(Way),
    setup_call_cleanup(
        connect(Way, Port, In, Out),
        ( welcome(Way, In),
          authenticate(client, In, Out, Hello, cookie, Peer),
          resume(Hello, Peer, In, Out),
          call(Goal, In, Out) ),
        close_streams(In, Out)).

resume(Hello, Peer, In, Out) :-
    key(Hello, Mine),
    key(Peer, Theirs),
    (   Mine @< Theirs
    ->  line_write(Out, "resume 0"),
        hear_line(In)
    ;   hear_line(In),
        line_write(Out, "resume 0")
    ).

key(hello(Process, Start, _, _, _, _), Key) :-
    atomic_list_concat([Process, Start], '.', Key).

hear_line(In) :-
    get_time(Now),
    Deadline is Now+10,
    line_read(In, Deadline, _).

say_frames(Frames, _, Out) :-
    catch(( forall(member(Codes, Frames), maplist(put_byte(Out), Codes)),
            flush_output(Out) ),
          error(_, _),
          true).

%   The end of the connection shows that the input was read.

goodbye(Codec, In, Out) :-
    term_bytes(Codec, bye, Bytes),
    catch(( frame_write(Out, counts(0, 0), Bytes),
            flush_output(Out),
            read_string(In, _, _) ),
          error(_, _),
          true).

		 /*******************************
		 *            VERDICT           *
		 *******************************/

served(Host) :-
    catch(peer_do(honest, remote(Host, true)), error(_, _), fail).

%   Sessions are of `honest`, of a random id, or of one of our peers.

nobody_in :-
    peer_do(victim,
            forall(( typhon_session:session(_, Session),
                     typhon_session:session_peer(Session, Process, _) ),
                   ( atom_length(Process, 16)
                   ; sub_atom(Process, 0, _, _, fuzz) ))).

small(Memory0) :-
    memory(Memory),
    Memory < Memory0+150 000.

%   Resident memory of the victim, in kB.

memory(KB) :-
    test_peers:peer(victim, Pid, _, _),
    format(atom(File), '/proc/~d/status', [Pid]),
    read_file_to_string(File, Text, []),
    split_string(Text, "\n", "", Lines),
    member(Line, Lines),
    string_concat("VmRSS:", Rest, Line),
    !,
    split_string(Rest, " \t", " \tkB", Words),
    member(Word, Words),
    number_string(KB, Word),
    !.

%   Workers come and go, and are not counted.

footprint([slots-Slots, sessions-Sessions, requests-Requests,
           agents-Agents, threads-Threads, queues-Queues]) :-
    peer_do(victim,
        ( aggregate_all(count, typhon_connection:unproved(_, _, _, _), Slots),
          aggregate_all(count, typhon_session:session(_, _), Sessions),
          aggregate_all(count, typhon_request:open_request(_, _, _),
                        Requests),
          aggregate_all(count, typhon_agents:agent(_, _, _, _, _), Agents),
          aggregate_all(count, typhon_threads:wire_thread(_), Threads),
          aggregate_all(count, message_queue_property(_, size(_)),
                        Queues) )).

aftermath(Before, Faults) :-
    linger_no_more(0),
    catch(wait_until(left(Before, []), 20),
          error(timeout_error(wait_until, _), _),
          true),
    left(Before, Faults).

left(Before, Faults) :-
    footprint(After),
    findall(fault(left(What, Count0, Count), at_the_end),
            ( member(What-Count, After),
              member(What-Count0, Before),
              Count > Count0 ),
            Faults).
